"""Statecharts with SCXML's meaning: an event and a snapshot become a step, and nothing else happens.

What runs them is loaded when it is first asked for: lint asks this package about types and names, and runs nothing.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from lumen.interpreters.statechart.deserialization import deserialize
    from lumen.interpreters.statechart.serialization import TimerPolicy, paused, retimed, serialize
    from lumen.interpreters.statechart.stepping import due, elapse, finished, initial, step
    from lumen.interpreters.statechart.values import (
        Awaiting,
        Counters,
        Fork,
        Halted,
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
    "Halted",
    "Invoked",
    "Position",
    "Snapshot",
    "Step",
    "Timer",
    "TimerPolicy",
    "Within",
    "deserialize",
    "due",
    "elapse",
    "finished",
    "initial",
    "paused",
    "retimed",
    "serialize",
    "step",
]

_MODULES = {
    "serialization": ("TimerPolicy", "paused", "retimed", "serialize"),
    "stepping": ("due", "elapse", "finished", "initial", "step"),
    "deserialization": ("deserialize",),
    "values": ("Awaiting", "Counters", "Fork", "Halted", "Invoked", "Position", "Snapshot", "Step", "Timer", "Within"),
}


def __getattr__(name: str) -> Any:
    for module, names in _MODULES.items():
        if name in names:
            found = globals()[name] = getattr(import_module(f"{__name__}.{module}"), name)
            return found
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
