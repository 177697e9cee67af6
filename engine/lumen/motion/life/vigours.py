"""How much of its life a robot shows: less where its motors are warm or its battery is low."""

WARM, HOT = 60.0, 72.0
"""Motors of a part of the body that are warmer than that move less, and from there on not at all [degrees Celsius]."""

LOW, EMPTY = 25.0, 5.0
"""A battery with less than that lets the robot do less, and from there on nothing of its own accord [%]."""


def vigour(temperature: float, percentage: float) -> float:
    """From 0 to 1: the part of its amplitudes that joints with this temperature show, with that much in the battery."""
    cool = (HOT - temperature) / (HOT - WARM)
    charged = (percentage - EMPTY) / (LOW - EMPTY)
    return max(0.0, min(1.0, cool, charged))
