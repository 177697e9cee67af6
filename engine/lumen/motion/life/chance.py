"""Chance without a generator: what happens when depends on the seed alone, not on who asked before."""

from functools import lru_cache
from math import floor
from zlib import crc32


@lru_cache(4096)
def chance(seed: int, what: str, number: int) -> float:
    """A number from 0 up to 1, always the same for the same three."""
    return crc32(f"{seed} {what} {number}".encode()) / 2**32


def moments(seed: int, what: str, every: float, t: float, length: float) -> tuple[int, float] | None:
    """The event of that kind that is under way at `t` [s], and how long it has been [s]; None for none.

    One falls into each `every` [s], never at its edge; it takes `length` [s], which is less.
    """
    number = floor(t / every)
    since = t - (number + chance(seed, what, number) * max(0.0, 1.0 - length / every)) * every
    return (number, since) if 0.0 <= since < length else None
