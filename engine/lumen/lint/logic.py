"""Static evaluation of conditions: whether a condition is never true, always true, or implied by another.

A condition is expanded to alternatives, each a set of claims about single values: that a value is true, equal to
something, or less than a number. An alternative with contradicting claims is impossible. Parts that are not understood
make no claim, so an answer of True is certain.
"""

from collections.abc import Iterable, Iterator
from itertools import product
from math import inf
from typing import NamedTuple

from lumen.expressions import parse_expression, unparse
from lumen.expressions.tree import Binary, ExpressionNode, FunctionCall, ListLiteral, Literal, Logic, Unary
from lumen.language.numbers import is_number

MAX_ALTERNATIVES = 24
"""The maximum number of alternatives of a condition; if it has more, nothing is concluded."""

_OPPOSITE = {"<": ">=", ">=": "<", ">": "<=", "<=": ">", "==": "!=", "!=": "=="}
_TURNED = {"<": ">", ">": "<", "<=": ">=", ">=": "<=", "==": "==", "!=": "!="}
_COUNTS = {"hour": (0, 23), "minute": (0, 59), "size": (0, inf)}
"""Functions that return whole numbers, each with its minimum and maximum result."""


class Claim(NamedTuple):
    """A claim about a value."""

    subject: str
    """The value, as written in the expression."""
    sign: str
    """A comparison with `value`, or `is`."""
    value: object
    """A literal; with `is`, True or False."""


Alternative = frozenset[Claim]


def tree(source: str) -> ExpressionNode:
    """Return the tree of an expression that is known to be valid."""
    return parse_expression(source)


def never(*conditions: ExpressionNode) -> bool:
    """Return whether conditions certainly can't all be true together; False if that is unknown."""
    spread = [_alternatives(condition, True) for condition in conditions]
    if any(s is None for s in spread):
        return False
    ways = [s for s in spread if s is not None]
    if _size(ways) > MAX_ALTERNATIVES:
        return False
    return not any(_possible(frozenset().union(*way)) for way in product(*ways))


def always(condition: ExpressionNode) -> bool:
    """Return whether a condition is certain to be true, unless it raises an error."""
    return never(Unary("!", condition))


def implies(condition: ExpressionNode, other: ExpressionNode) -> bool:
    """Return whether `other` is certainly true whenever `condition` is; False if that is unknown."""
    return never(condition, Unary("!", other))


def _size(ways: Iterable[list[Alternative]]) -> int:
    size = 1
    for way in ways:
        size *= max(len(way), 1)
    return size


def _alternatives(node: ExpressionNode, value: bool) -> list[Alternative] | None:
    """Return the alternatives in which a condition has that value; None if there are too many."""
    match node:
        case Literal(value=bool() as given):
            return [frozenset()] if given == value else []
        case Unary(sign="!", operand=operand):
            return _alternatives(operand, not value)
        case Logic(sign=sign, operands=operands):
            spread = [_alternatives(operand, value) for operand in operands]
            ways = [s for s in spread if s is not None]
            if len(ways) < len(spread):
                return None
            if (sign == "&&") != value:
                return (
                    [a for way in ways for a in way][: MAX_ALTERNATIVES + 1]
                    if sum(map(len, ways)) <= MAX_ALTERNATIVES
                    else None
                )
            return [frozenset().union(*way) for way in product(*ways)] if _size(ways) <= MAX_ALTERNATIVES else None
        case Binary(sign="in", left=left, right=ListLiteral(items=items)) if all(isinstance(i, Literal) for i in items):
            claims = [Claim(unparse(left), "==" if value else "!=", i.value) for i in items if isinstance(i, Literal)]
            return [frozenset((c,)) for c in claims] if value else [frozenset(claims)]
        case Binary(sign=sign, left=left, right=right) if sign in _OPPOSITE:
            return _compared(left, sign if value else _OPPOSITE[sign], right)
    return [frozenset((Claim(unparse(node), "is", value),))]


def _compared(left: ExpressionNode, sign: str, right: ExpressionNode) -> list[Alternative] | None:
    """Return a list with the alternative in which a comparison holds; empty if it compares literals and is false."""
    if isinstance(left, Literal) and isinstance(right, Literal):
        claim = Claim("", sign, right.value)
        return [frozenset()] if _holds(left.value, claim) else []
    if isinstance(left, Literal):
        left, right, sign = right, left, _TURNED[sign]
    if not isinstance(right, Literal):
        return [frozenset((Claim(f"{unparse(left)} {sign} {unparse(right)}", "is", True),))]
    if isinstance(right.value, bool) and sign in ("==", "!="):
        return [frozenset((Claim(unparse(left), "is", right.value == (sign == "==")),))]
    return [frozenset((Claim(unparse(left), sign, right.value), *_counted(left)))]


def _counted(node: ExpressionNode) -> Iterator[Claim]:
    """Yield the bounds of a function's result."""
    if isinstance(node, FunctionCall) and node.function in _COUNTS:
        low, high = _COUNTS[node.function]
        yield Claim(unparse(node), ">=", low)
        yield Claim(unparse(node), "<=", high)


def _possible(alternative: Alternative) -> bool:
    """Return whether the claims about each value can hold together."""
    about: dict[str, list[Claim]] = {}
    for claim in alternative:
        about.setdefault(claim.subject, []).append(claim)
    return all(map(_agree, about.values()))


def _agree(claims: list[Claim]) -> bool:
    if len(claims) == 1:
        return True
    if len({c.value for c in claims if c.sign == "is"}) > 1:
        return False
    equal = [c.value for c in claims if c.sign == "=="]
    if equal:
        return all(_holds(equal[0], c) for c in claims if c.sign != "is")
    low, closed_low = _bound(claims, ">", ">=", -inf)
    high, closed_high = _bound(claims, "<", "<=", inf)
    return low < high or (low == high and closed_low and closed_high and not any(_excludes(c, low) for c in claims))


def _bound(claims: list[Claim], strict: str, loose: str, start: float) -> tuple[float, bool]:
    """Return the tightest bound on one side, and whether the bound itself is allowed.

    It is the lower bound if `start` is negative, else the upper bound.
    """
    bounds = [(c.value, c.sign == loose) for c in claims if c.sign in (strict, loose) and is_number(c.value)]
    values = [start, *(value for value, _ in bounds if isinstance(value, int | float))]
    tightest = max(values) if start < 0 else min(values)
    return tightest, all(closed for value, closed in bounds if value == tightest)


def _excludes(claim: Claim, value: float) -> bool:
    return claim.sign == "!=" and is_number(claim.value) and claim.value == value


def _holds(value: object, claim: Claim) -> bool:
    """Return whether a claim holds for that value; True if they can't be compared."""
    if claim.sign in ("==", "!="):
        same = (
            is_number(value) == is_number(claim.value) and value == claim.value and _kind(value) == _kind(claim.value)
        )
        return same == (claim.sign == "==")
    if not (isinstance(value, int | float) and isinstance(claim.value, int | float)):
        return True
    match claim.sign:
        case "<":
            return value < claim.value
        case "<=":
            return value <= claim.value
        case ">":
            return value > claim.value
    return value >= claim.value


def _kind(value: object) -> type:
    return float if is_number(value) else type(value)
