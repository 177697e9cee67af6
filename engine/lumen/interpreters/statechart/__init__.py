"""Statecharts with SCXML's meaning: an event and a snapshot become a step, and nothing else happens."""

from lumen.interpreters.statechart.stepping import due, initial, step
from lumen.interpreters.statechart.values import Awaiting, Counters, Fork, Position, Snapshot, Step, Timer, Within

__all__ = [
    "Awaiting",
    "Counters",
    "Fork",
    "Position",
    "Snapshot",
    "Step",
    "Timer",
    "Within",
    "due",
    "initial",
    "step",
]
