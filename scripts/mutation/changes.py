"""Small changes of Python source, one at a time, each of which a test should notice.

Annotations, docstrings, `TYPE_CHECKING`, `__all__`, f-strings, strings with a space in them (texts for people),
`assert_never`, and code that only saves time or memory (`cache`, `slots`) are never changed.
"""

import ast
import re
import warnings
from collections.abc import Iterator, Sequence
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import NamedTuple

COMPARISONS = {
    "<": ("<=", ">="), "<=": ("<", ">"), ">": (">=", "<="), ">=": (">", "<"), "==": ("!=",), "!=": ("==",),
    "is": ("is not",), "is not": ("is",), "in": ("not in",), "not in": ("in",),
}  # fmt: skip
COMPARISON = re.compile(r"not\s+in\b|is\s+not\b|<=|>=|==|!=|<|>|\bis\b|\bin\b")
ARITHMETIC = {
    "+": "-", "-": "+", "*": "/", "/": "*", "//": "*", "%": "*", "**": "*", "<<": ">>", ">>": "<<", "&": "|", "|": "&",
}  # fmt: skip
OPERATOR = re.compile(r"\*\*|//|<<|>>|[-+*/%&|]")
CALLS = {
    "min": "max", "max": "min", "any": "all", "all": "any", "sorted": "list", "reversed": "list", "abs": "float",
    "startswith": "endswith", "endswith": "startswith", "lower": "upper", "strip": "rstrip",
}  # fmt: skip
DECORATORS = {"cache", "lru_cache", "overload", "override", "final", "abstractmethod", "runtime_checkable"}
"""Decorators that only save time, or that only a type checker uses."""
TYPING = {"cast", "TypeVar", "NewType", "ParamSpec", "assert_never"}
LISTS = (ast.stmt, ast.excepthandler)


class Change(NamedTuple):
    """Replace the bytes `start:end` of a file by `text`; `shown` is the part of the file to show, as bytes."""

    kind: str
    start: int
    end: int
    text: str
    shown: tuple[int, int]


class Statement(NamedTuple):
    """A statement, and the names it binds if it is executed when the module is imported."""

    node: ast.stmt
    binds: frozenset[str] = frozenset()

    @property
    def header(self) -> range:
        """Return the lines of the statement itself, without those of the statements inside it."""
        body = getattr(self.node, "body", None) or getattr(self.node, "cases", None)
        last = self.node.end_lineno or self.node.lineno
        inner = body[0] if isinstance(body, list) else None
        if inner is not None:
            first = inner.pattern.lineno if isinstance(inner, ast.match_case) else inner.lineno
            last = max(self.node.lineno, first - 1)
        return range(self.node.lineno, last + 1)


class Source:
    """A file, its statements and their possible changes."""

    def __init__(self, file: Path) -> None:
        self.content = file.read_bytes()
        self.tree = ast.parse(self.content)
        lines = self.content.splitlines(keepends=True)
        self._starts = [0, 0]
        for line in lines:
            self._starts.append(self._starts[-1] + len(line))

    @cached_property
    def statements(self) -> list[Statement]:
        """Return the statements that may be changed."""
        return list(_statements(self.tree.body, imported=True))

    def changed(self, change: Change) -> bytes | None:
        """Return the file after the change, or None if it does not compile or means the same."""
        content = self.content[: change.start] + change.text.encode() + self.content[change.end :]
        try:
            with warnings.catch_warnings(action="ignore"):
                tree = ast.parse(content)
                compile(content, "mutant", "exec")
        except (SyntaxError, ValueError):
            return None
        return None if ast.dump(tree) == ast.dump(self.tree) else content

    def lines(self, change: Change) -> range:
        """Return the lines that a change touches."""
        first = self.content.count(b"\n", 0, change.start) + 1
        return range(first, first + self.content.count(b"\n", change.start, max(change.start, change.end - 1)) + 1)

    def first_line(self, node: ast.stmt) -> str:
        """Return the first line of a statement."""
        return self.content[self._starts[node.lineno] :].partition(b"\n")[0].decode().strip()

    def shown(self, change: Change) -> tuple[str, str]:
        """Return the source before and after a change, each on one line."""
        start, end = change.shown
        before = self.content[start:end].decode()
        after = (self.content[start : change.start] + change.text.encode() + self.content[change.end : end]).decode()
        return _one_line(before), _one_line(after)

    def changes(self, statement: ast.stmt) -> list[Change]:
        """Return every change of a statement itself, without nested statements; assign None if there is no other."""
        found = [*self._statement(statement)]
        for node in _expressions(statement):
            found += self._expression(node)
        match statement:
            case ast.Assign(value=ast.expr() as value) | ast.AnnAssign(value=ast.expr() as value):
                if not found and not isinstance(value, ast.Constant):
                    found.append(self._replace("assign", value, "None", statement))
        return found

    def _statement(self, node: ast.stmt) -> Iterator[Change]:
        match node:
            case ast.Expr(ast.Call() | ast.Await()) | ast.AugAssign() | ast.Raise() | ast.Delete() | ast.Assert():
                yield self._replace("delete", node, "pass")
            case ast.Assign(targets=[ast.Attribute() | ast.Subscript()]):
                yield self._replace("delete", node, "pass")
            case ast.Return(ast.expr() as value) if not _is_none(value):
                yield self._replace("return", value, "None", node)
            case ast.Break():
                yield from (self._replace("jump", node, word) for word in ("continue", "pass"))
            case ast.Continue():
                yield from (self._replace("jump", node, word) for word in ("break", "pass"))
            case ast.If(test, body, orelse):
                yield self._negate(test, node)
                yield self._block(body, "pass")
                if orelse and not self.content[self._start(orelse[0]) :].startswith(b"elif"):
                    yield self._block(orelse, "pass")
            case ast.Match(_, cases):
                yield from (self._block(case.body, "pass") for case in cases if not _never(case.body))
            case ast.Try(_, handlers, _, finalbody):
                yield from (self._block(handler.body, "raise") for handler in handlers)
                if finalbody:
                    yield self._block(finalbody, "pass")
        if isinstance(node, ast.AugAssign) and isinstance(node.op, ast.Add | ast.Sub):
            new = "-=" if isinstance(node.op, ast.Add) else "+="
            yield from self._gap("arithmetic", node.target, node.value, node, re.compile(r"[-+]="), (new,))
        for decorator in getattr(node, "decorator_list", ()):
            if not DECORATORS & {n.id for n in ast.walk(decorator) if isinstance(n, ast.Name)}:
                start = self.content.rindex(b"@", 0, self._start(decorator))
                yield Change("decorator", start, self._end(decorator), "", (start, self._end(decorator)))

    def _expression(self, node: ast.AST) -> Iterator[Change]:
        match node:
            case ast.Compare(left, _, comparators):
                for one, other in pairwise([left, *comparators]):
                    found = COMPARISON.search(self._between(one, other))
                    others = COMPARISONS[" ".join(found[0].split())] if found else ()
                    yield from self._gap("comparison", one, other, node, COMPARISON, others)
            case ast.BoolOp(op, values):
                new = "or" if isinstance(op, ast.And) else "and"
                for one, other in pairwise(values):
                    yield from self._gap("and, or", one, other, node, re.compile(r"\b(and|or)\b"), (new,))
                if len(values) == 2:
                    yield from (self._replace("and, or", node, f"({self._text(value)})") for value in values)
            case ast.UnaryOp(ast.Not() | ast.USub(), operand):
                yield self._replace("not, minus", node, f"({self._text(operand)})")
            case ast.BinOp(left, _, right) if not isinstance(left, LITERALS) and not isinstance(right, LITERALS):
                found = OPERATOR.search(self._between(left, right))
                if found and not _is_text(left) and not _is_text(right):
                    yield from self._gap("arithmetic", left, right, node, OPERATOR, (ARITHMETIC[found[0]],))
            case ast.Constant(value):
                yield from (self._replace("constant", node, text) for text in _others(value))
            case ast.IfExp(test):
                yield self._negate(test, node)
            case ast.comprehension(ifs=[*ifs]):
                for test in ifs:
                    yield self._negate(test, test)
                    yield self._replace("condition", test, "True")
            case ast.Call():
                yield from self._call(node)
            case ast.Yield(ast.expr() as value) if not _is_none(value):
                yield self._replace("return", value, "None", node)

    def _call(self, node: ast.Call) -> Iterator[Change]:
        match node.func:
            case ast.Name(name) | ast.Attribute(_, name) if name in CALLS:
                end = self._end(node.func)
                yield Change("call", end - len(name), end, CALLS[name], (self._start(node), self._end(node)))
        if len(node.args) >= 2 and not any(isinstance(arg, ast.Starred) for arg in node.args[:2]):
            one, other = node.args[:2]
            text = f"{self._text(other)}, {self._text(one)}"
            span = (self._start(node), self._end(node))
            yield Change("call", self._start(one), self._end(other), text, span)
        for before, keyword in pairwise([*node.args, *node.keywords]):
            if isinstance(keyword, ast.keyword) and keyword.arg not in (None, "slots"):
                span = (self._start(node), self._end(node))
                yield Change("call", self._end(before), self._end(keyword), "", span)

    def _replace(self, kind: str, node: ast.AST, text: str, shown: ast.AST | None = None) -> Change:
        span = (self._start(shown or node), self._end(shown or node))
        return Change(kind, self._start(node), self._end(node), text, span)

    def _negate(self, test: ast.expr, shown: ast.AST) -> Change:
        shown = test if isinstance(shown, ast.stmt) else shown
        return self._replace("condition", test, f"(not ({self._text(test)}))", shown)

    def _block(self, body: Sequence[ast.stmt], text: str) -> Change:
        start, end = self._start(body[0]), self._end(body[-1])
        return Change("branch", start, end, text, (start, end))

    def _gap(
        self, kind: str, one: ast.AST, other: ast.AST, shown: ast.AST, operator: re.Pattern[str], new: Sequence[str]
    ) -> Iterator[Change]:
        """Replace the operator between two expressions."""
        if found := operator.search(self._between(one, other)):
            at, span = self._end(one), (self._start(shown), self._end(shown))
            yield from (Change(kind, at + found.start(), at + found.end(), text, span) for text in new)

    def _between(self, one: ast.AST, other: ast.AST) -> str:
        return self.content[self._end(one) : self._start(other)].decode("latin-1")

    def _text(self, node: ast.AST) -> str:
        text = self.content[self._start(node) : self._end(node)].decode()
        return f"({text})" if "\n" in text else text

    def _start(self, node: ast.AST) -> int:
        first = [*getattr(node, "decorator_list", ()), node][0]
        at = self._starts[first.lineno] + first.col_offset
        return at if first is node else self.content.rindex(b"@", 0, at)

    def _end(self, node: ast.AST) -> int:
        return self._starts[node.end_lineno] + node.end_col_offset  # type: ignore[attr-defined]


LITERALS = (ast.JoinedStr, ast.List, ast.Tuple, ast.Dict)


def _statements(body: Sequence[ast.stmt], *, imported: bool, owner: str = "") -> Iterator[Statement]:
    """Yield the statements that may be changed, including nested ones."""
    for node in body:
        match node:
            case ast.Import() | ast.ImportFrom() | ast.Expr(ast.Constant()) | ast.Pass() | ast.Global():
                continue
            case ast.If(test) if "TYPE_CHECKING" in ast.dump(test):
                continue
            case ast.Expr(ast.Call(ast.Name("assert_never"))):
                continue
            case ast.Assign([ast.Name(name)], value) if imported and (name == "__all__" or _is_type(name, value)):
                continue
        yield Statement(node, frozenset(_bound(node, owner)) if imported else frozenset())
        within = not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef) and imported
        name = node.name if isinstance(node, ast.ClassDef) else owner
        for block in (*_blocks(node), *(inner.body for inner in (*_handlers(node), *getattr(node, "cases", ())))):
            yield from _statements(block, imported=within, owner=name)


def _blocks(node: ast.stmt) -> Iterator[Sequence[ast.stmt]]:
    yield from (getattr(node, field, ()) for field in ("body", "orelse", "finalbody"))


def _handlers(node: ast.stmt) -> Sequence[ast.excepthandler]:
    return getattr(node, "handlers", ())


def _bound(node: ast.stmt, owner: str) -> Iterator[str]:
    """Yield the names by which the rest of the engine can use what a statement defines."""
    match node:
        case ast.FunctionDef(name) | ast.AsyncFunctionDef(name) | ast.ClassDef(name):
            yield owner if name.startswith("__") and owner else name
        case ast.Assign() | ast.AnnAssign() | ast.AugAssign():
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            yield from (name.id for target in targets for name in ast.walk(target) if isinstance(name, ast.Name))
        case _:
            yield owner


def _expressions(statement: ast.stmt) -> Iterator[ast.AST]:
    """Yield the expressions of a statement that may be changed, outside the statements inside it."""
    left: list[ast.AST] = [statement]
    while left:
        node = left.pop()
        if isinstance(node, ast.JoinedStr):
            continue
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in TYPING:
            left += node.args[1:]
            continue
        if node is not statement:
            yield node
        for field, value in ast.iter_fields(node):
            inner = value if isinstance(value, list) else [value]
            if field in ("annotation", "returns", "bases", "decorator_list", "pattern"):
                continue
            left += [one for one in inner if isinstance(one, ast.AST) and not isinstance(one, LISTS)]


def _others(value: object) -> tuple[str, ...]:
    """Return other constants than this one, as source."""
    match value:
        case None:
            return ("1",)
        case bool():
            return (str(not value),)
        case int() | float():
            others = {repr(value + 1), repr(type(value)(0)) if value else repr(value - 1), repr(value * 2 or value + 1)}
            return tuple(sorted(text if text[0] != "-" else f"({text})" for text in others))
        case str() if not re.search(r"\s", value):
            return (repr(value + "X"), "''") if value else ("'X'",)
    return ()


def _is_none(node: ast.AST) -> bool:
    return isinstance(node, ast.Constant) and node.value is None


def _is_text(node: ast.AST) -> bool:
    return isinstance(node, ast.Constant) and isinstance(node.value, str)


def _is_type(name: str, value: ast.AST) -> bool:
    """Return True if an assignment gives a type another name."""
    return name[:1].isupper() and not name.isupper() and isinstance(value, ast.Subscript | ast.BinOp)


def _never(body: Sequence[ast.stmt]) -> bool:
    return "assert_never" in ast.dump(body[0])


def _one_line(text: str) -> str:
    return " ".join(text.split())
