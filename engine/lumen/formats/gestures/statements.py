"""The statements of a Python file in their order, each with what may keep it from being carried out once."""

import ast
from collections.abc import Iterator
from enum import Enum


class Branch(Enum):
    """Where a statement stands: `ALWAYS` is carried out once, as far as a reader can tell."""

    ALWAYS = "always"
    IF = "if"
    ELSE = "else"
    LOOP = "loop"


def statements(tree: ast.Module) -> Iterator[tuple[ast.stmt, Branch]]:
    """The simple statements, functions and classes opened where they stand; what handles exceptions is left out."""
    waiting = [(statement, Branch.ALWAYS) for statement in reversed(tree.body)]
    while waiting:
        statement, branch = waiting.pop()
        parts: list[tuple[list[ast.stmt], Branch]]
        match statement:
            case ast.FunctionDef() | ast.AsyncFunctionDef() | ast.ClassDef() | ast.With() | ast.AsyncWith():
                parts = [(statement.body, branch)]
            case ast.Try() | ast.TryStar():
                parts = [(part, branch) for part in (statement.body, statement.orelse, statement.finalbody)]
            case ast.For() | ast.AsyncFor() | ast.While():
                parts = [(statement.body, Branch.LOOP), (statement.orelse, Branch.LOOP)]
            case ast.If() if _is_main(statement.test):
                parts = [(statement.body, branch)]
            case ast.If():
                parts = [(statement.body, _within(branch, Branch.IF)), (statement.orelse, _within(branch, Branch.ELSE))]
            case _:
                yield statement, branch
                continue
        waiting += [(inner, where) for body, where in reversed(parts) for inner in reversed(body)]


def _within(around: Branch, branch: Branch) -> Branch:
    """The branch of a statement within another: what is left out or repeated stays so."""
    return branch if around in (Branch.ALWAYS, Branch.IF) else around


def _is_main(test: ast.expr) -> bool:
    """Whether an `if` is the one around what a file does when it is run, or no question at all."""
    match test:
        case ast.Compare(left=ast.Name(id="__name__")) | ast.Constant(value=True | 1):
            return True
    return False


MUTATING_METHODS = frozenset(("append", "extend", "insert", "pop", "remove", "sort", "reverse", "clear"))


def changed_names(statement: ast.stmt, own_functions: frozenset[str]) -> frozenset[str]:
    """The variables that a statement sets or changes, also within lists and by functions that the file defines."""
    found: set[str] = set()
    for node in ast.walk(statement):
        match node:
            case ast.Assign(targets=targets) | ast.Delete(targets=targets):
                found.update(name for target in targets for name in _targets(target))
            case ast.AugAssign(target=target) | ast.AnnAssign(target=target) | ast.NamedExpr(target=target):
                found.update(_targets(target))
            case ast.Call(func=ast.Attribute(value=owner, attr=method)) if method in MUTATING_METHODS:
                found.update(_targets(owner))
            case ast.Call(func=ast.Name(id=name) | ast.Attribute(attr=name), args=args) if name in own_functions:
                found.update(argument.id for argument in args if isinstance(argument, ast.Name))
    return frozenset(found)


def functions_of(tree: ast.Module) -> frozenset[str]:
    """The functions that a file defines and hands something to."""
    return frozenset(n.name for n in ast.walk(tree) if isinstance(n, ast.FunctionDef) and n.args.args)


def _targets(target: ast.expr) -> Iterator[str]:
    """The variables in what is assigned to: of `a, b[0].c` that is `a` and `b`."""
    waiting = [target]
    while waiting:
        match waiting.pop():
            case ast.Name(id=name):
                yield name
            case ast.Subscript(value=value) | ast.Starred(value=value) | ast.Attribute(value=value):
                waiting.append(value)
            case ast.Tuple(elts=parts) | ast.List(elts=parts):
                waiting += parts
