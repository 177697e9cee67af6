"""Attacks by number, which determines an attack's kind and random generator: an attack is always the same."""

from collections.abc import Iterator
from enum import StrEnum
from random import Random
from typing import NamedTuple


class Kind(StrEnum):
    """The way an attack enters: a message, a frame, an imported file or a saved project file."""

    MESSAGE = "message"
    FRAME = "frame"
    FOREIGN = "import"
    FILE = "file"


SHARES = {Kind.MESSAGE: 0.58, Kind.FRAME: 0.3588, Kind.FOREIGN: 0.06, Kind.FILE: 0.0012}
"""The share of each kind among all attacks. Saved files are rare: each costs a reload, a message 1 % of that."""


class Attack(NamedTuple):
    """One attack; its generator draws from `random`."""

    number: int
    kind: Kind
    random: Random


def attack(number: int) -> Attack:
    """Return the attack with that number."""
    random = Random(number)
    (kind,) = random.choices(list(SHARES), list(SHARES.values()))
    return Attack(number, kind, random)


def batches(numbers: list[int], size: int) -> Iterator[list[int]]:
    """Yield the numbers in order, `size` at a time; the last batch may be smaller."""
    for begin in range(0, len(numbers), size):
        yield numbers[begin : begin + size]
