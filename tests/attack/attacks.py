"""Attacks by their number: which kind each is, and what it draws from. The same number is always the same attack."""

from collections.abc import Iterator
from enum import StrEnum
from random import Random
from typing import NamedTuple


class Kind(StrEnum):
    """Where an attack comes in."""

    MESSAGE = "message"
    FRAME = "frame"
    FOREIGN = "import"
    FILE = "file"


SHARES = {Kind.MESSAGE: 0.58, Kind.FRAME: 0.3588, Kind.FOREIGN: 0.06, Kind.FILE: 0.0012}
"""How many of all attacks are of each kind: a file that is saved costs a reload, a message a hundredth of that."""


class Attack(NamedTuple):
    """One attack; `random` is what its generator draws from."""

    number: int
    kind: Kind
    random: Random


def attack(number: int) -> Attack:
    """The attack of that number."""
    random = Random(number)
    (kind,) = random.choices(list(SHARES), list(SHARES.values()))
    return Attack(number, kind, random)


def batches(numbers: list[int], size: int) -> Iterator[list[int]]:
    """So many at a time, in their order."""
    for begin in range(0, len(numbers), size):
        yield numbers[begin : begin + size]
