"""Bodies in memory and as bytes."""

import json
from collections import OrderedDict
from enum import IntEnum, StrEnum
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lumen.bus.bodies import MAX_BODY_BYTES, copied, decode, encode
from lumen.errors import BusError
from tests.tables import for_each

INTEGERS = st.integers(-(2**63), 2**63)
SCALARS = st.none() | st.booleans() | INTEGERS | st.floats(allow_nan=False, allow_infinity=False) | st.text()
BODIES = st.recursive(SCALARS, lambda b: st.lists(b, max_size=4) | st.dictionaries(st.text(), b, max_size=4))


class Word(StrEnum):
    STAND = "Stand"


class Number(IntEnum):
    ONE = 1


@given(BODIES)
def test_a_copy_is_what_a_round_trip_through_text_gives(body: Any) -> None:
    assert json.dumps(copied(body)) == json.dumps(json.loads(json.dumps(body)))


@given(BODIES)
def test_bytes_give_back_what_was_encoded(body: Any) -> None:
    assert decode(encode(body)) == body


def test_a_copy_shares_no_container() -> None:
    body = {"a": [{"b": []}]}
    copy = copied(body)
    copy["a"][0]["b"].append(1)
    assert body == {"a": [{"b": []}]}


@for_each(
    ("body", "plain"),
    [
        (Word.STAND, "Stand"),
        (Number.ONE, 1),
        (OrderedDict(a=(1, 2)), {"a": [1, 2]}),
        (np.float64(0.5), 0.5),
        ({Word.STAND: 1}, {"Stand": 1}),
    ],
)
def test_relatives_of_json_types_become_json(body: Any, plain: Any) -> None:
    assert copied(body) == plain
    assert type(copied(body)) is type(plain)


NO_NUMBERS = [float("inf"), float("-inf"), float("nan"), 2**63 + 1, -(2**63) - 1, 10**400, True + 2**64]
INSIDE = [lambda n: n, lambda n: {"time": n}, lambda n: [n], lambda n: (0.5, n), lambda n: [1, n], lambda n: ["a", [n]]]


@for_each("inside", INSIDE)
@for_each("number", NO_NUMBERS)
def test_a_number_that_is_no_finite_float_is_never_sent(number: float, inside: Any) -> None:
    with pytest.raises(BusError, match=r"JSON has no number|between -2\*\*63 and 2\*\*63"):
        copied(inside(number))


class Huge(int):
    """A subclass of a number."""


def test_a_relative_of_a_number_has_the_same_bounds() -> None:
    with pytest.raises(BusError, match="between"):
        copied(Huge(10**400))
    with pytest.raises(BusError, match="JSON"):
        copied({"x": np.float64("nan")})


@for_each("number", [2**63, -(2**63), 1e308, -1e308, 5e-324])
def test_the_greatest_numbers_are_sent(number: float) -> None:
    assert copied([number, {"x": number}, [number, number]]) == [number, {"x": number}, [number, number]]
    assert decode(encode([number, {"x": number}])) == [number, {"x": number}]


@for_each("body", [np.float32(0.5), np.zeros(2), {None: 1}, {"x": float("-inf")}, "\ud800"])
def test_what_json_has_not_is_refused_with_a_reason(body: Any) -> None:
    with pytest.raises(BusError, match=r"JSON|keys|Unicode"):
        encode(body)


def test_too_many_bytes_are_refused_on_both_sides() -> None:
    with pytest.raises(BusError, match="bytes"):
        encode("x" * MAX_BODY_BYTES)
    with pytest.raises(ValueError, match="bytes"):
        decode(b" " * (MAX_BODY_BYTES + 1))


@for_each(
    ("data", "reason"),
    [
        (b"\xff\xfe", "UTF-8"),
        (b"{'x': 1}", "JSON"),
        (b"", "JSON"),
        (b"[NaN]", "NaN"),
        (b"[" * 10_000 + b"]" * 10_000, "nested"),
        (b"[" * 100 + b"]" * 100, "nested"),
        (b'{"a":' * 100 + b"1" + b"}" * 100, "nested"),
        (b'{"time": 1e999}', "JSON has no number"),
        (b"[0.5, -1e999]", "JSON has no number"),
        (b'{"x": 1' + b"0" * 400 + b"}", r"between -2\*\*63 and 2\*\*63"),
        (b"[9223372036854775809]", "between"),
        (b'{"x": 1' + b"0" * 5000 + b"}", "thousands of digits"),
        (b"-Infinity", "Infinity"),
    ],
)
def test_bytes_that_are_no_body_are_refused_with_a_reason(data: bytes, reason: str) -> None:
    with pytest.raises(ValueError, match=reason):
        decode(data)


def test_many_brackets_side_by_side_are_no_nesting() -> None:
    assert decode(encode([[i] for i in range(1000)])) == [[i] for i in range(1000)]


def test_plain_text_is_itself() -> None:
    assert decode(b"dia Budi", "text/plain; charset=utf-8") == "dia Budi"
