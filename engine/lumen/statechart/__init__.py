"""Statecharts with SCXML's meaning: an event and a snapshot become a step, and nothing else happens.

Each name is imported when it is first used: lint uses types and names of this package, and runs nothing. `__init__.pyi`
has the same names for type checkers.
"""

from lumen.upkeep.lazy_names import lazy

__all__ = ["Event", "Interpreter", "Machine", "Snapshot", "Step", "VirtualClock", "due", "initial", "step"]

_HOMES = {
    "lumen.standalone.machine": ("Interpreter", "Machine"),
    "lumen.clock.virtual": ("VirtualClock",),
    "lumen.language.events": ("Event",),
    "lumen.statechart.serialization": ("TimerPolicy", "paused", "retimed", "serialize"),
    "lumen.statechart.stepping": ("due", "elapse", "finished", "initial", "step"),
    "lumen.statechart.deserialization": ("deserialize",),
    "lumen.statechart.values": (
        "Awaiting",
        "Counters",
        "Fork",
        "Halted",
        "Invoked",
        "Position",
        "Snapshot",
        "Step",
        "Timer",
        "Within",
    ),
}

__getattr__ = lazy(__name__, _HOMES)
