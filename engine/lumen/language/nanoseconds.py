"""Time as timers count it: whole nanoseconds, so that a hundred times 10 ms is a second to the last digit."""

NANOSECONDS = 1_000_000_000
"""In a second."""
NEVER = 2**63
"""So late [ns] that it never comes."""
HALF = 0.5 / NANOSECONDS
"""Times that are less apart [s] are the same time."""


def nanoseconds(seconds: float) -> int:
    """A time or a length of time [s] in whole nanoseconds, the nearest; one beyond all measure is NEVER."""
    try:
        return round(seconds * NANOSECONDS)
    except (OverflowError, ValueError):  # infinite, NaN
        return NEVER


def in_seconds(nanoseconds: int) -> float:
    """That time [s]; `nanoseconds` gives it back for the first hundred days."""
    return nanoseconds / NANOSECONDS


def to_the_nanosecond(seconds: float) -> float:
    """The time [s] of the nearest whole nanosecond: what a clock shows that adds up short lengths of time."""
    return in_seconds(nanoseconds(seconds))
