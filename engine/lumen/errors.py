"""Everything that can go wrong outside our own code.

LumenError
 ├── ProjectError      the YAML can't be used; carries the diagnostics that say why
 ├── UsageError        a flag, a name or a path given to Lumen is wrong
 ├── ExpressionError   an expression can't be read, or has no value here
 ├── SnapshotError     a snapshot belongs to another machine
 ├── RobotError        the robot can't do what was asked, or is gone
 ├── BusError          the broker is gone, or refuses
 └── ModuleError       a module (memory, eyes, ears, voice, social) can't do its work

A fault in somebody's YAML is a `Diagnostic`, collected and returned; a fault in the world is one of these, and
becomes an `Event` while an exhibition runs. A fault in Lumen itself is none of them and is allowed to crash.
"""

from collections.abc import Sequence

from lumen.language.diagnostics import Diagnostic


class LumenError(Exception):
    """Base of all errors that Lumen raises on purpose; `str` is one line that says what to do."""


class ProjectError(LumenError):
    """The project's YAML has errors; `diagnostics` holds every one of them, warnings included."""

    def __init__(self, diagnostics: Sequence[Diagnostic]) -> None:
        self.diagnostics = tuple(diagnostics)
        errors = [d for d in self.diagnostics if d.severity == "error"]
        first = str(errors[0]) if errors else "no diagnostics"
        more = f" (and {len(errors) - 1} more)" if len(errors) > 1 else ""
        super().__init__(first + more)


class UsageError(LumenError):
    """What the caller asked for can't be: a missing folder, an unknown name, options that exclude each other."""


class ExpressionError(LumenError):
    """An expression that can't be read, or that has no value in this scope.

    `offset` counts the characters of the expression's source (of the whole text, in a template) from 0; `hint` says
    what would be right, and is empty where there is nothing to say.
    """

    def __init__(self, message: str, offset: int = 0, hint: str = "") -> None:
        self.message, self.offset, self.hint = message, offset, hint
        super().__init__(f"{message} ({hint})" if hint else message)


class SnapshotError(LumenError):
    """A snapshot does not fit the machine it should be restored into; the message names the difference."""


class RobotError(LumenError):
    """The robot refused or failed a command, or there is no robot."""


class BusError(LumenError):
    """The bus can't be reached, was closed, or refused a message."""


class ModuleError(LumenError):
    """A module lacks what it works with, or can't use what it was sent; the tour goes on without it."""
