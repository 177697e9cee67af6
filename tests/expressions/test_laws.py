"""Laws of the language, on random expressions."""

import warnings
from collections.abc import Callable
from typing import Any

from hypothesis import example, given, settings
from hypothesis import strategies as st

from lumen.expressions import (
    ExpressionError,
    ExpressionNode,
    Scope,
    check_expression,
    check_template,
    compile_expression,
    compile_guard,
    compile_template,
    parse_expression,
    unparse,
)
from lumen.expressions.function_table import functions
from lumen.expressions.tree import (
    Binary,
    Conditional,
    FieldAccess,
    FunctionCall,
    Identifier,
    IndexAccess,
    ListLiteral,
    Literal,
    Logic,
    MapLiteral,
    Unary,
)
from tests.expressions.scopes import SCOPE

PATIENT = settings(deadline=None)
"""No time limit: a busy machine is no fault of an expression."""

WORDS = st.sampled_from(
    ["n", "x", "name", "list", "map", "a", "b", "none", "yes", "data", "result", "path", "q", "in", "true"]
)
LITERALS = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(-(2**63), 2**63 - 1),
    st.integers(-3, 3),
    st.text(max_size=5),
    st.floats(allow_nan=False, allow_infinity=False),
).map(Literal)
ROOTS = st.sampled_from(["context", "event", "state"]).map(Identifier)
PATHS = st.recursive(ROOTS, lambda base: st.builds(FieldAccess, base, WORDS), max_leaves=4)
SIGNS = st.sampled_from(["==", "!=", "<", "<=", ">", ">=", "in", "+", "-", "*", "/", "%"])


def _minus(operand: ExpressionNode) -> bool:
    """Return whether a text can have this operand of `-`: before a number, `-` is read as a part of it."""
    return not (isinstance(operand, Literal) and type(operand.value) in (int, float))


def _larger(nodes: st.SearchStrategy[Any]) -> st.SearchStrategy[Any]:
    several = st.lists(nodes, min_size=2, max_size=3).map(tuple)
    keys = st.lists(st.text(max_size=3), max_size=3, unique=True).map(tuple)
    entries = keys.flatmap(lambda k: st.tuples(st.just(k), st.tuples(*[nodes] * len(k))))
    calls = st.sampled_from(sorted(functions())).flatmap(
        lambda name: st.tuples(st.just(name), st.tuples(*[nodes] * len(functions()[name].parameters)))
    )
    unary = st.builds(Unary, st.just("!"), nodes) | st.builds(Unary, st.just("-"), nodes.filter(_minus))
    return st.one_of(
        st.builds(FieldAccess, nodes, WORDS),
        st.builds(IndexAccess, nodes, nodes),
        st.lists(nodes, max_size=3).map(tuple).map(ListLiteral),
        entries.map(lambda e: MapLiteral(*e)),
        unary,
        st.builds(Binary, SIGNS, nodes, nodes),
        st.builds(Logic, st.sampled_from(["&&", "||"]), several),
        st.builds(Conditional, nodes, nodes, nodes),
        calls.map(lambda c: FunctionCall(*c)),
    )


TREES = st.recursive(LITERALS | PATHS, _larger, max_leaves=15)


def run(source: str, scope: Scope) -> Any:
    """Return the value, or None for an expression without one; warnings of Python's compiler count as failures."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        return attempt(source, lambda: compile_expression.__wrapped__(source)(scope))


def attempt(source: str, action: Callable[[], Any]) -> Any:
    """Return the action's result, or None if it raises an ExpressionError, whose place must be in the source."""
    offset = 0
    try:
        return action()
    except ExpressionError as error:
        offset = error.offset
    assert 0 <= offset <= len(source)
    return None


@PATIENT
@given(TREES)
@example(Literal("\x7f\u2028\"'\\\n"))
@example(FieldAccess(Literal(-1), "a"))
@example(Unary("-", FieldAccess(Literal(1), "a")))
@example(Logic("&&", (Logic("&&", (Literal(True), Literal(False))), Literal(True))))
def test_printed_and_parsed_it_is_the_same_tree(tree: ExpressionNode) -> None:
    assert repr_without_places(parse_expression(unparse(tree))) == repr_without_places(tree)


def repr_without_places(tree: Any) -> Any:
    """Return the tree as tuples, in which 1, 1.0 and true are different."""
    if isinstance(tree, tuple):
        return tuple(map(repr_without_places, tree))
    if not hasattr(tree, "__slots__"):
        return repr(tree)
    shown = {name: getattr(tree, name) for name in tree.__match_args__ if name not in ("offset", "end", "named")}
    return type(tree).__name__, {name: repr_without_places(value) for name, value in shown.items()}


@PATIENT
@given(TREES)
@example(Binary("==", Literal(1), Literal(None)))
@example(FieldAccess(ListLiteral((Literal(1),)), "a"))
@example(IndexAccess(Literal("a"), Literal("a")))
def test_evaluation_gives_a_value_or_an_expression_error(tree: ExpressionNode) -> None:
    run(unparse(tree), SCOPE)
    run(unparse(tree), Scope())
    check_expression(unparse(tree), context={"n": {"type": "integer"}, "map": {"type": "object"}}, events={"heard": {}})


@PATIENT
@given(TREES)
def test_evaluation_is_pure(tree: ExpressionNode) -> None:
    before = repr(SCOPE)
    first = run(unparse(tree), SCOPE)
    assert repr(run(unparse(tree), SCOPE)) == repr(first)
    assert repr(SCOPE) == before


@PATIENT
@given(TREES)
def test_what_is_found_wrong_has_no_value(tree: ExpressionNode) -> None:
    """If lint reports the left operand of `-` as a type mismatch, the expression has no value at run time."""
    source = unparse(Binary("-", tree, Literal(1)))
    found = check_expression(source, context=None)
    if any(f.code == "type-mismatch" and f.message.endswith("needed by `-`") and f.offset == 0 for f in found):
        assert run(source, SCOPE) is None


@PATIENT
@given(st.lists(TREES, min_size=2, max_size=4))
def test_the_order_of_a_conjunction_does_not_matter(trees: list[ExpressionNode]) -> None:
    def decided(operands: list[ExpressionNode]) -> Any:
        return run(unparse(Logic("&&", tuple(operands))), SCOPE)

    assert decided(trees) is decided(trees[::-1])


@PATIENT
@given(st.binary(max_size=60).map(lambda data: data.decode("utf-8", "surrogateescape")) | st.text(max_size=60))
def test_any_text_is_read_or_refused(source: str) -> None:
    run(source, SCOPE)
    check_expression(source, context={})
    check_template(source, context={})


PIECES = [
    "context",
    ".",
    "n",
    "event",
    "(",
    ")",
    "[",
    "]",
    "{",
    "}",
    "'a'",
    ",",
    ":",
    "?",
    "&&",
    "||",
    "!",
    "-",
    "+",
    "==",
    "<",
    "1",
    "2.5",
    "in",
    "size",
    "has",
    "{{",
    "}}",
    " ",
    "'",
    "null",
]


@PATIENT
@given(st.lists(st.sampled_from(PIECES), max_size=15).map("".join))
def test_any_row_of_pieces_is_read_or_refused(source: str) -> None:
    run(source, SCOPE)
    attempt(source, lambda: compile_guard(source)(SCOPE))
    attempt(source, lambda: compile_template(source)(SCOPE))
