"""The operators of the language: functions that compiled expressions call.

They raise the errors of `kinds`, to which `explain` adds the place.
"""

from collections.abc import Mapping
from math import fmod, isfinite
from typing import Any

from lumen.expressions.kinds import (
    BOOLEAN,
    LIST,
    MAP,
    NUMBER,
    TEXT,
    FaultError,
    MismatchError,
    WrongKindError,
    kind_of,
)
from lumen.expressions.scope import (
    MAX_COLLECTION_VALUES,
    MAX_INT,
    MAX_TEXT_LENGTH,
    MAX_TREE_DEPTH,
    MIN_INT,
)

_SCALARS = frozenset((type(None), bool, int, float))


def truth(value: Any) -> bool:
    """Return a boolean operand of `&&`, `||` or `?`, or the value of a guard; raise WrongKindError for other kinds."""
    if value is True or value is False:
        return bool(value)
    raise WrongKindError(-1, value, BOOLEAN)


def negation(value: Any) -> bool:
    """Return `!value`; raise WrongKindError if the value is not a boolean."""
    if value is True or value is False:
        return not value
    raise WrongKindError(0, value, BOOLEAN)


def equal(left: Any, right: Any) -> bool:
    """Return True if two values are equal; values of different kinds are unequal, but 1 and 1.0 are equal."""
    kind = kind_of(left)
    if kind != kind_of(right):
        return False
    if kind is LIST:
        return len(left) == len(right) and all(map(equal, left, right))
    if kind is MAP:
        return left.keys() == right.keys() and all(equal(left[key], right[key]) for key in left)
    return bool(left == right)


def contained(value: Any, collection: Any) -> bool:
    """Return `value in collection`: an element of a list, or a key of a map; raise WrongKindError for other kinds."""
    kind = kind_of(collection)
    if kind is LIST:
        return any(equal(value, element) for element in collection)
    if kind is MAP:
        return isinstance(value, str) and value in collection
    raise WrongKindError(1, collection, LIST, MAP)


def _comparable(left: Any, right: Any) -> None:
    kind = kind_of(left)
    if kind != kind_of(right) or kind not in (NUMBER, TEXT, BOOLEAN):
        raise MismatchError(left, right)


def less(left: Any, right: Any) -> bool:
    """Return `left < right`; raise MismatchError unless both are numbers, texts or booleans."""
    _comparable(left, right)
    return bool(left < right)


def at_most(left: Any, right: Any) -> bool:
    """Return `left <= right`; raises as `less` does."""
    _comparable(left, right)
    return bool(left <= right)


def greater(left: Any, right: Any) -> bool:
    """Return `left > right`; raises as `less` does."""
    _comparable(left, right)
    return bool(left > right)


def at_least(left: Any, right: Any) -> bool:
    """Return `left >= right`; raises as `less` does."""
    _comparable(left, right)
    return bool(left >= right)


def _in_range(value: Any) -> Any:
    good = MIN_INT <= value <= MAX_INT if isinstance(value, int) else isfinite(value)
    if good:
        return value
    raise FaultError("the number becomes too large", "whole numbers have 64 bits, others go up to 1.8e308")


def _numbers(left: Any, right: Any) -> None:
    if kind_of(left) != NUMBER:
        raise WrongKindError(0, left, NUMBER)
    if kind_of(right) != NUMBER:
        raise WrongKindError(1, right, NUMBER)
    for number in (left, right):
        if isinstance(number, int):
            _in_range(number)


def add(left: Any, right: Any) -> Any:
    """Return the sum of two numbers, or the concatenation of two texts or lists.

    Raises MismatchError for other pairs of kinds, and FaultError if the result is too large.
    """
    if type(left) is int and type(right) is int and MIN_INT <= (total := left + right) <= MAX_INT:
        return total
    kind = kind_of(left)
    if kind != kind_of(right) or kind not in (NUMBER, TEXT, LIST):
        raise MismatchError(left, right)
    if kind is NUMBER:
        _numbers(left, right)
        return _in_range(left + right)
    if kind is TEXT:
        bounded_text(len(left) + len(right))
        return left + right
    if len(left) + len(right) > MAX_COLLECTION_VALUES:
        raise FaultError("the list becomes too long", f"at most {MAX_COLLECTION_VALUES:,} values are allowed")
    return [*left, *right]


def bounded_text(length: int) -> None:
    """Raise FaultError if a text of this length exceeds MAX_TEXT_LENGTH."""
    if length > MAX_TEXT_LENGTH:
        raise FaultError("the text becomes too long", f"at most {MAX_TEXT_LENGTH:,} characters are allowed")


def subtract(left: Any, right: Any) -> Any:
    """Return the difference of two numbers; raise WrongKindError for other kinds, FaultError if it is out of range."""
    _numbers(left, right)
    return _in_range(left - right)


def multiply(left: Any, right: Any) -> Any:
    """Return the product of two numbers; raise WrongKindError for other kinds, FaultError if it is out of range."""
    _numbers(left, right)
    return _in_range(left * right)


def divide(left: Any, right: Any) -> Any:
    """Return the quotient, for two integers rounded towards zero, as in CEL; raise FaultError for a zero divisor."""
    _numbers(left, right)
    if right == 0:
        raise FaultError("this divides by zero")
    if isinstance(left, float) or isinstance(right, float):
        return _in_range(left / right)
    quotient = abs(left) // abs(right)
    return _in_range(quotient if (left < 0) == (right < 0) else -quotient)


def remainder(left: Any, right: Any) -> Any:
    """Return the remainder of `divide`, with the sign of `left`, as in CEL; raise FaultError for a zero divisor."""
    _numbers(left, right)
    if right == 0:
        raise FaultError("this divides by zero")
    if isinstance(left, float) or isinstance(right, float):
        return fmod(left, right)
    return left - right * divide(left, right)


def negative(value: Any) -> Any:
    """Return the negated number; raise WrongKindError for other kinds, FaultError if it is out of range."""
    if kind_of(value) != NUMBER:
        raise WrongKindError(0, value, NUMBER)
    return _in_range(-value)


def item(base: Any, key: Any) -> Any:
    """Return `base[key]`: an element of a list, counted from 0, or the value of a key.

    Raises KeyError for a missing key, FaultError for a missing element, and WrongKindError for other kinds.
    """
    kind = kind_of(base)
    if kind is MAP:
        if not isinstance(key, str):
            raise WrongKindError(1, key, TEXT)
        return base[key]
    if kind is not LIST:
        raise WrongKindError(0, base, LIST, MAP)
    if kind_of(key) != NUMBER:
        raise WrongKindError(1, key, NUMBER)
    if key != int(key) or not 0 <= key < len(base):
        raise FaultError(f"there is no element {key} in a list of length {len(base)}", "count from 0")
    return base[int(key)]


def has(base: Any, *keys: Any) -> bool:
    """Return whether a path of keys and indices leads to a value in `base`."""
    for key in keys:
        kind = kind_of(base)
        if kind is LIST and kind_of(key) == NUMBER and key == int(key) and 0 <= key < len(base):
            base = base[int(key)]
        elif kind is MAP and isinstance(key, str) and key in base:
            base = base[key]
        else:
            return False
    return True


def bounded(value: Any) -> Any:
    """Return the value; raise FaultError if it has too many values, levels or characters."""
    if type(value) in _SCALARS:
        return value
    count, characters, level, values = 0, 0, 0, [value]
    while values:
        count += len(values)
        level += 1
        characters += sum(len(v) for v in values if isinstance(v, str))
        if count > MAX_COLLECTION_VALUES or characters > 10 * MAX_TEXT_LENGTH or level > MAX_TREE_DEPTH:
            hint = f"at most {MAX_COLLECTION_VALUES:,} values in {MAX_TREE_DEPTH} levels are allowed"
            raise FaultError("the value becomes too large", hint)
        lists = [v for v in values if isinstance(v, list | tuple)]
        maps = [v for v in values if isinstance(v, Mapping)]
        if sum(map(len, lists)) + sum(map(len, maps)) > MAX_COLLECTION_VALUES:
            values = [None] * MAX_COLLECTION_VALUES
            continue
        values = [e for v in lists for e in v] + [e for v in maps for e in v.values()]
    return value
