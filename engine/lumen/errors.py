"""Everything that can go wrong outside our own code.

LumenError
 ├── ProjectError      the YAML can't be used; carries the diagnostics that say why
 ├── FatalFilesError   reading the project's files crashes the process that reads them, or takes too long
 ├── UsageError        a flag, a name or a path given to Lumen is wrong; MissingExtraError: packages are not installed
 ├── ExpressionError   an expression can't be read, or has no value here
 ├── SnapshotError     a snapshot belongs to another machine
 ├── WorkersError      who does tasks can't be reached, runs another engine, or was lost
 ├── JournalError      a journal, or an entry of it, can't be read
 ├── RecordingError    a recording can't be read, or can't be written
 ├── RobotError        the robot can't be used, or can't do what it should
 │    ├── RobotUnreachableError   there is no robot at the address
 │    ├── RobotLostError          the connection broke, or the robot does not answer any more
 │    ├── RobotModelError         the robot, or its model, lacks something that Lumen needs
 │    ├── BadCommandError         no robot of this type can do that, now or later
 │    ├── RobotRefusedError       the robot can't begin that in its present state
 │    ├── RobotFailedError        the robot began, and did not succeed
 │    └── SenseError              a sensor gives no usable value
 ├── BusError          the bus can't be used, or does not accept a message
 │    ├── BusAddressError         the address, or a file that it names, is not valid
 │    ├── BusUnreachableError     no broker, or no exhibition, answers there
 │    ├── BusRefusedError         it answers, but does not allow this user or process to do that
 │    ├── BusClosedError          the bus was closed, or the exhibition that owns it has ended
 │    ├── BusFullError            too many messages are waiting to be sent
 │    └── BadMessageError         the body or the key can't be sent
 ├── Refused           raised by a subscriber for a message that it can't use
 ├── ModuleError       a module (memory, eyes, ears, voice, social, show) can't do its work
 └── UndeliveredError  an alert did not reach its recipient

A fault in somebody's YAML is a `Diagnostic`, collected and returned; a fault in the world is one of these, and
becomes an `Event` while an exhibition runs. A fault in Lumen itself is none of them and is allowed to crash.
"""

from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:  # each start of `lumen` imports this module, and `--help` has no findings
    from lumen.language.diagnostics import Diagnostic


class LumenError(Exception):
    """Base of all errors that Lumen raises on purpose; `str` is one line that says what to do."""


class ProjectError(LumenError):
    """The project's YAML has errors; `diagnostics` holds every one of them, warnings included."""

    def __init__(self, diagnostics: "Sequence[Diagnostic]") -> None:
        self.diagnostics = tuple(diagnostics)
        errors = [d for d in self.diagnostics if d.severity == "error"]
        first = str(errors[0]) if errors else "no diagnostics"
        more = f" (and {len(errors) - 1} more)" if len(errors) > 1 else ""
        super().__init__(first + more)


class FatalFilesError(LumenError):
    """Reading a project's files crashes the reading process, or exceeds its memory or time: Lumen does not read them.

    `overdue` is whether it took too long.
    """

    def __init__(self, message: str, *, overdue: bool = False) -> None:
        super().__init__(message)
        self.overdue = overdue


class UsageError(LumenError):
    """The request can't be carried out: a missing folder, an unknown name, options that exclude each other."""


class WorkersError(LumenError):
    """Tasks can't be done: a cluster does not answer or runs other software, or workers were lost twice."""


class ExpressionError(LumenError):
    """An expression that can't be read, or that has no value in this scope.

    `offset` counts the characters of the expression's source (of the whole text, in a template) from 0; `hint` says
    what would be right, and may be empty.
    """

    def __init__(self, message: str, offset: int = 0, hint: str = "") -> None:
        self.message, self.offset, self.hint = message, offset, hint
        super().__init__(f"{message} ({hint})" if hint else message)


class SnapshotError(LumenError):
    """A snapshot does not fit the machine that should be restored from it; the message names the difference."""


class JournalError(LumenError):
    """A journal of inputs, or an entry of it, can't be read by this Lumen."""


class RecordingError(LumenError):
    """A file is not a recording (MCAP), or a recording can't be written to the disk."""


class RobotError(LumenError):
    """The robot can't be used, or can't do what it should."""


class RobotUnreachableError(RobotError):
    """No robot at its address, or the package `qi` that reaches one is missing: check the address, then try again."""


class RobotLostError(RobotError):
    """The connection to the robot broke, or it does not answer any more; the robot reconnects by itself."""


class RobotModelError(RobotError):
    """The robot, or its model (`models/`, MuJoCo), lacks something that Lumen needs: correct that, then start again."""


class BadCommandError(RobotError):
    """No robot of this type can do that: no such method, joint or posture, or a number out of range.

    Sending it again changes nothing: change the command.
    """


class RobotRefusedError(RobotError):
    """The robot can't begin that in its present state: fallen, motors off, in another posture, at the stage's edge.

    Nothing has moved. Bring it into the state that the message names, then send the command again.
    """


class RobotFailedError(RobotError):
    """The robot began, and did not succeed: it may have stopped between two postures or places."""


class SenseError(RobotError):
    """A sensor is missing, or gives no usable value; the other senses still work."""


class BusError(LumenError):
    """The bus can't be used, or does not accept a message."""


class BusAddressError(BusError):
    """The address of the bus, or a file of credentials or certificates that it names, is not valid: correct it."""


class BusUnreachableError(BusError):
    """At the address there is no broker that Lumen can use: start one there, or try again later."""


class BusRefusedError(BusError):
    """The broker refuses: wrong name, password or virtual host, a missing right, or another process has this role.

    Trying again changes nothing.
    """


class BusClosedError(BusError):
    """The bus was closed, here or by the exhibition that owned it: connect again.

    The loss of a broker raises nothing: an open bus reconnects by itself.
    """


class BusFullError(BusError):
    """Too many messages that must arrive are waiting for the broker: send this one again later."""


class BadMessageError(BusError):
    """The body is not JSON data, too large, or does not fit its route's schema, or the key is too long: correct it."""


class Refused(LumenError):  # noqa: N818  an answer to the bus, not an error of the sender
    """Raised by a handler for a message that it can't use; the text says why.

    If the sender wants an answer, the bus sends the reason; a broker puts the message aside, with the reason.
    """


class ModuleError(LumenError):
    """A module lacks something that it needs, or can't use a message; the exhibition continues without it."""


class UndeliveredError(LumenError):
    """An alert did not arrive; `final` is whether a new attempt would fail in the same way."""

    def __init__(self, message: str, *, final: bool = False) -> None:
        super().__init__(message)
        self.final = final
