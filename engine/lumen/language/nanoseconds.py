"""Time in whole nanoseconds, so that timers add up exactly: a hundred times 10 ms is one second."""

NANOSECONDS = 1_000_000_000
"""The nanoseconds in a second."""
NEVER = 2**63
"""A time that is never reached [ns]."""
HALF = 0.5 / NANOSECONDS
"""Times closer than this are the same time [s]."""


def nanoseconds(seconds: float) -> int:
    """Return a time or a length of time [s] in whole nanoseconds, rounded; NEVER if it is infinite or NaN."""
    try:
        return round(seconds * NANOSECONDS)
    except (OverflowError, ValueError):  # infinite, NaN
        return NEVER


def in_seconds(nanoseconds: int) -> float:
    """Return a time [ns] in seconds; `nanoseconds` is its exact inverse for the first hundred days."""
    return nanoseconds / NANOSECONDS


def to_the_nanosecond(seconds: float) -> float:
    """Return a time [s] rounded to whole nanoseconds, so that many short times add up to the same as one long time."""
    return in_seconds(nanoseconds(seconds))
