"""Analyses a Python file: its statements in order, marked if they may not run exactly once, and its functions."""

import ast
import re
from collections.abc import Callable, Iterator
from enum import Enum
from typing import NamedTuple

from lumen.features.formats_motion.naoqi_calls import ALMOTION_CALLS


class Branch(Enum):
    """The kind of block that contains a statement; `ALWAYS` runs exactly once, as far as the source shows."""

    ALWAYS = "always"
    IF = "if"
    ELSE = "else"
    LOOP = "loop"


def statements(
    body: list[ast.stmt], around: Branch, items: Callable[[ast.For], list[ast.expr] | None]
) -> Iterator[tuple[ast.stmt, Branch]]:
    """Yield simple statements, whole functions and classes, and the head expressions of compound statements.

    An exception handler counts as an `else`. A `for` loop is repeated for each value that `items` returns.
    """
    waiting = [(statement, around) for statement in reversed(body)]
    while waiting:
        statement, branch = waiting.pop()
        parts: list[tuple[list[ast.stmt], Branch]]
        head: list[ast.expr] = []
        match statement:
            case ast.With() | ast.AsyncWith():
                head, parts = [item.context_expr for item in statement.items], [(statement.body, branch)]
            case ast.Try() | ast.TryStar():
                parts = [(part, branch) for part in (statement.body, statement.orelse)]
                parts += [(handler.body, _within(branch, Branch.ELSE)) for handler in statement.handlers]
                parts.append((statement.finalbody, branch))
            case ast.For(target=target) if (rounds := items(statement)) is not None:
                parts = []
                for item in rounds:
                    setting = ast.copy_location(ast.Assign([target], item), statement.iter)
                    parts += [([setting], branch), (statement.body, branch)]
                parts.append((statement.orelse, branch))
            case ast.For() | ast.AsyncFor() | ast.While():
                head = [statement.test if isinstance(statement, ast.While) else statement.iter]
                parts = [(statement.body, Branch.LOOP), (statement.orelse, Branch.LOOP)]
            case ast.If() if _is_main(statement.test):
                parts = [(statement.body, branch)]
            case ast.If():
                head = [statement.test]
                parts = [(statement.body, _within(branch, Branch.IF)), (statement.orelse, _within(branch, Branch.ELSE))]
            case _:
                yield statement, branch
                continue
        for asked in head:
            yield ast.copy_location(ast.Expr(asked), asked), branch
        waiting += [(inner, where) for body, where in reversed(parts) for inner in reversed(body)]


def has_jumps(loop: ast.For) -> bool:
    """Return whether an iteration of a loop can end early."""
    return any(isinstance(node, ast.Break | ast.Continue | ast.Return) for node in _inner(loop.body))


def _within(around: Branch, branch: Branch) -> Branch:
    """Return a nested statement's branch: if the outer statement is an `else` or in a loop, so is the inner one."""
    return branch if around in (Branch.ALWAYS, Branch.IF) else around


def _is_main(test: ast.expr) -> bool:
    """Return whether an `if` is always true, or only tests whether the file runs as a program."""
    match test:
        case (
            ast.Compare(left=ast.Name(id="__name__"), ops=[ast.Eq()], comparators=[ast.Constant(value="__main__")])
            | ast.Constant(value=True | 1)
        ):
            return True
    return False


FunctionNode = ast.FunctionDef | ast.AsyncFunctionDef


class OwnFunctions:
    """The functions and methods that a file defines, by name; the last definition of a name is used."""

    def __init__(self, tree: ast.Module) -> None:
        self.plain: dict[str, FunctionNode] = {}
        self.methods: dict[str, FunctionNode] = {}
        classes = [node for node in ast.walk(tree) if isinstance(node, ast.ClassDef)]
        of_classes = {id(inner) for node in classes for inner in node.body}
        for node in ast.walk(tree):
            if isinstance(node, FunctionNode):
                (self.methods if id(node) in of_classes else self.plain)[node.name] = node
        for node in classes:
            begin = next((f for f in node.body if isinstance(f, FunctionNode) and f.name == "__init__"), None)
            if begin:
                self.plain.setdefault(node.name, begin)
        self.all = {**self.methods, **self.plain}
        self.classes = {node.name for node in classes}

    def called(self, call: ast.Call) -> FunctionNode | None:
        """Return the file's function that a call refers to, or None."""
        match call.func:
            case ast.Name(id=name):
                return self.plain.get(name)
            case ast.Attribute(value=ast.Name(id=owner), attr=name) if owner == "self" or name not in _OF_NAOQI:
                return self.methods.get(name)
        return None

    def reached(self, body: list[ast.stmt]) -> set[str]:
        """Return the names of the functions that statements call, directly or indirectly."""
        found: set[str] = set()
        waiting = [body]
        while waiting:
            for call in (inner for inner in _inner(waiting.pop()) if isinstance(inner, ast.Call)):
                function = self.called(call)
                if function and function.name not in found:
                    found.add(function.name)
                    waiting.append(function.body)
        return found

    def is_gesture(self, body: list[ast.stmt]) -> bool:
        """Return whether statements move joints, directly or through functions, or fill a motion's lists."""
        whole = [body, *(self.all[name].body for name in self.reached(body) if name in self.all)]
        return any(_moves(part) for part in whole) or lists_of(body) is not None


_OF_NAOQI = frozenset((*ALMOTION_CALLS, "say", "move", "rest", "play", "sleep", "wait"))
"""Names of methods that are NAOqi's, unless called on `self`."""


class NamedLists(NamedTuple):
    """The variables that contain a motion's names, times and keys."""

    names: str
    times: str
    keys: str


USUAL_LISTS = NamedLists("names", "times", "keys")


def _inner(body: list[ast.stmt]) -> Iterator[ast.AST]:
    """Yield the syntax nodes in statements, except those in nested functions and classes."""
    waiting: list[ast.AST] = list(body)
    while waiting:
        node = waiting.pop()
        if not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
            yield node
            waiting += ast.iter_child_nodes(node)


def _moves(body: list[ast.stmt]) -> bool:
    return any(isinstance(n, ast.Call) and attribute(n) in ALMOTION_CALLS for n in _inner(body))


def lists_of(body: list[ast.stmt]) -> NamedLists | None:
    """Return the variables in which statements store a motion's lists; None if there are none.

    They are named as in Choregraphe's export, or returned as a tuple of three.
    """
    nodes = list(_inner(body))
    if set(USUAL_LISTS) <= {n.id for n in nodes if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)}:
        return USUAL_LISTS
    for node in nodes:
        match node:
            case ast.Return(value=ast.Tuple(elts=[ast.Name(id=a), ast.Name(id=b), ast.Name(id=c)])):
                names = next((name for name in (a, b, c) if re.search("name|joint", name, re.IGNORECASE)), "")
                times = next((name for name in (a, b, c) if re.search("time", name, re.IGNORECASE)), "")
                if names and times and names != times:
                    return NamedLists(names, times, next(name for name in (a, b, c) if name not in (names, times)))
    return None


def attribute(call: ast.Call) -> str:
    """Return the last part of a called name, such as `move` in `motion.move()`; empty without a name."""
    match call.func:
        case ast.Name(id=name) | ast.Attribute(attr=name):
            return name
    return ""


MUTATING_METHODS = frozenset(("append", "extend", "insert", "pop", "remove", "sort", "reverse", "clear"))


def changed_names(statement: ast.stmt) -> frozenset[str]:
    """Return the variables that a statement sets, deletes or changes, including changes of their items."""
    found: set[str] = set()
    for node in ast.walk(statement):
        match node:
            case ast.Assign(targets=targets) | ast.Delete(targets=targets):
                found.update(name for target in targets for name in _targets(target))
            case ast.AugAssign(target=target) | ast.AnnAssign(target=target) | ast.NamedExpr(target=target):
                found.update(_targets(target))
            case ast.Call(func=ast.Attribute(value=owner, attr=method)) if method in MUTATING_METHODS:
                found.update(_targets(owner))
    return frozenset(found)


def _targets(target: ast.expr) -> Iterator[str]:
    """Yield the variables in an assignment's target, such as `a` and `b` in `a, b[0].c`."""
    waiting = [target]
    while waiting:
        match waiting.pop():
            case ast.Name(id=name):
                yield name
            case ast.Subscript(value=value) | ast.Starred(value=value) | ast.Attribute(value=value):
                waiting.append(value)
            case ast.Tuple(elts=parts) | ast.List(elts=parts):
                waiting += parts
