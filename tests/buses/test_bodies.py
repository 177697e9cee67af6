"""Bodies in memory and as bytes."""

import json
from collections import OrderedDict
from enum import IntEnum, StrEnum
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lumen.buses.bodies import MAX_BYTES, copied, decode, encode
from lumen.errors import BusError

SCALARS = st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False) | st.text()
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


@pytest.mark.parametrize(
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


@pytest.mark.parametrize("body", [np.float32(0.5), np.zeros(2), {None: 1}, {"x": float("-inf")}, "\ud800"])
def test_what_json_has_not_is_refused_with_a_reason(body: Any) -> None:
    with pytest.raises(BusError, match=r"JSON|keys|Unicode"):
        encode(body)


def test_too_many_bytes_are_refused_on_both_sides() -> None:
    with pytest.raises(BusError, match="bytes"):
        encode("x" * MAX_BYTES)
    with pytest.raises(ValueError, match="bytes"):
        decode(b" " * (MAX_BYTES + 1))


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        (b"\xff\xfe", "UTF-8"),
        (b"{'x': 1}", "JSON"),
        (b"", "JSON"),
        (b"[NaN]", "NaN"),
        (b"[" * 10_000 + b"]" * 10_000, "nested"),
        (b"[" * 100 + b"]" * 100, "nested"),
        (b'{"a":' * 100 + b"1" + b"}" * 100, "nested"),
    ],
)
def test_bytes_that_are_no_body_are_refused_with_a_reason(data: bytes, reason: str) -> None:
    with pytest.raises(ValueError, match=reason):
        decode(data)


def test_many_brackets_side_by_side_are_no_nesting() -> None:
    assert decode(encode([[i] for i in range(1000)])) == [[i] for i in range(1000)]


def test_plain_text_is_itself() -> None:
    assert decode(b"dia Budi", "text/plain; charset=utf-8") == "dia Budi"
