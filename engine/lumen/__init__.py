"""Lumen: the behaviour of a humanoid robot, written in YAML.

The names below are the public API, which stays compatible; each is imported when it is first used, so that `import
lumen` costs nothing.
"""

from typing import TYPE_CHECKING

from lumen.upkeep.lazy_names import lazy

if TYPE_CHECKING:
    from lumen.errors import (
        BadCommandError,
        BadMessageError,
        BusAddressError,
        BusClosedError,
        BusError,
        BusFullError,
        BusRefusedError,
        BusUnreachableError,
        ExpressionError,
        FatalFilesError,
        JournalError,
        LumenError,
        ModuleError,
        ProjectError,
        RecordingError,
        Refused,
        RobotError,
        RobotFailedError,
        RobotLostError,
        RobotModelError,
        RobotRefusedError,
        RobotUnreachableError,
        SenseError,
        SnapshotError,
        UndeliveredError,
        UsageError,
        WorkersError,
    )
    from lumen.language.diagnostics import Diagnostic
    from lumen.language.events import Event
    from lumen.language.projects import Project
    from lumen.lint import check
    from lumen.project import load
    from lumen.run.exhibition import Exhibition
    from lumen.run.opening import open
    from lumen.run.recalling import why, why_not

__version__ = "0.1.0"

__all__ = [
    "BadCommandError",
    "BadMessageError",
    "BusAddressError",
    "BusClosedError",
    "BusError",
    "BusFullError",
    "BusRefusedError",
    "BusUnreachableError",
    "Diagnostic",
    "Event",
    "Exhibition",
    "ExpressionError",
    "FatalFilesError",
    "JournalError",
    "LumenError",
    "ModuleError",
    "Project",
    "ProjectError",
    "RecordingError",
    "Refused",
    "RobotError",
    "RobotFailedError",
    "RobotLostError",
    "RobotModelError",
    "RobotRefusedError",
    "RobotUnreachableError",
    "SenseError",
    "SnapshotError",
    "UndeliveredError",
    "UsageError",
    "WorkersError",
    "__version__",
    "check",
    "load",
    "open",
    "why",
    "why_not",
]

_HOMES = {
    "lumen.run.exhibition": ("Exhibition",),
    "lumen.run.opening": ("open",),
    "lumen.run.recalling": ("why", "why_not"),
    "lumen.errors": (
        "BadCommandError",
        "BadMessageError",
        "BusAddressError",
        "BusClosedError",
        "BusError",
        "BusFullError",
        "BusRefusedError",
        "BusUnreachableError",
        "ExpressionError",
        "FatalFilesError",
        "JournalError",
        "LumenError",
        "ModuleError",
        "ProjectError",
        "RecordingError",
        "Refused",
        "RobotError",
        "RobotFailedError",
        "RobotLostError",
        "RobotModelError",
        "RobotRefusedError",
        "RobotUnreachableError",
        "SenseError",
        "SnapshotError",
        "UndeliveredError",
        "UsageError",
        "WorkersError",
    ),
    "lumen.language.diagnostics": ("Diagnostic",),
    "lumen.language.events": ("Event",),
    "lumen.language.projects": ("Project",),
    "lumen.project": ("load",),
    "lumen.lint": ("check",),
}

__getattr__ = lazy(__name__, _HOMES)


def __dir__() -> list[str]:
    return __all__
