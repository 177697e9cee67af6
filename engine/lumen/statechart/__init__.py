"""Statecharts with the semantics of SCXML: `step` maps an event and a snapshot to a step, without side effects.

Each name is imported on first use, because lint needs the types and names of this package but runs nothing.
`__init__.pyi` declares the same names for type checkers.
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
