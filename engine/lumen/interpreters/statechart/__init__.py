"""Statecharts with SCXML's meaning: an event and a snapshot become a step, and nothing else happens."""

from lumen.interpreters.statechart.frozen import Timing, freeze, retimed
from lumen.interpreters.statechart.stepping import due, elapse, initial, step
from lumen.interpreters.statechart.thawing import thaw
from lumen.interpreters.statechart.values import (
    Awaiting,
    Counters,
    Fork,
    Invoked,
    Position,
    Snapshot,
    Step,
    Timer,
    Within,
)

__all__ = [
    "Awaiting",
    "Counters",
    "Fork",
    "Invoked",
    "Position",
    "Snapshot",
    "Step",
    "Timer",
    "Timing",
    "Within",
    "due",
    "elapse",
    "freeze",
    "initial",
    "retimed",
    "step",
    "thaw",
]
