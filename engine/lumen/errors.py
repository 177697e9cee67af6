"""Everything that can go wrong outside our own code.

LumenError
 ├── ProjectError      the YAML can't be used; carries the diagnostics that say why
 ├── FatalFilesError   reading the project's files ends the process that does it
 ├── UsageError        a flag, a name or a path given to Lumen is wrong
 ├── ExpressionError   an expression can't be read, or has no value here
 ├── SnapshotError     a snapshot belongs to another machine
 ├── RobotError        the robot can't be used, or can't do what it should
 │    ├── RobotUnreachableError   there is none at the address
 │    ├── RobotLostError          it was there, and is gone or silent
 │    ├── RobotModelError         it, or the model it is simulated from, lacks what is needed
 │    ├── BadCommandError         no robot of this body could do that, now or later
 │    ├── RobotRefusedError       it does not begin that as it stands now
 │    ├── RobotFailedError        it began, and did not succeed
 │    └── SenseError              a sensor gives nothing that can be used
 ├── BusError          the bus can't be used, or does not take a message
 │    ├── BusAddressError         the address, or a file that it names, is none
 │    ├── BusUnreachableError     no broker, or no exhibition, answers there
 │    ├── BusRefusedError         it answers, and does not let this user or process do that
 │    ├── BusClosedError          it was closed, or whose bus it was has ended
 │    ├── BusFullError            too much waits to be sent already
 │    └── BadMessageError         the body or the key can't be sent
 ├── Refused           a subscriber's word for a message that it can't use
 ├── ModuleError       a module (memory, eyes, ears, voice, social, show) can't do its work
 └── UndeliveredError  an alert did not reach who was to be told

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


class FatalFilesError(LumenError):
    """Reading a project's files crashes, fills or holds up the process that does it: they are not read here.

    `overdue` is whether it took too long.
    """

    def __init__(self, message: str, *, overdue: bool = False) -> None:
        super().__init__(message)
        self.overdue = overdue


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
    """The robot can't be used, or can't do what it should."""


class RobotUnreachableError(RobotError):
    """No robot at its address, or the package `qi` that reaches one is missing: check the address, then try again."""


class RobotLostError(RobotError):
    """The connection to the robot broke, or it does not answer any more; the robot reconnects by itself."""


class RobotModelError(RobotError):
    """The robot, or what it is simulated from (`models/`, MuJoCo), lacks what is needed: mend that, then start anew."""


class BadCommandError(RobotError):
    """No robot of this body can do that: no such method, joint or posture, or a number out of range.

    Sending it again changes nothing: change the command.
    """


class RobotRefusedError(RobotError):
    """The robot does not begin that as it stands: fallen, motors off, in another posture, at the edge of the stage.

    Nothing has moved. Bring it into the state that the message names, then send the command again.
    """


class RobotFailedError(RobotError):
    """The robot began, and something kept it from succeeding: it may stand in between."""


class SenseError(RobotError):
    """A sensor is missing, or gives nothing that can be used; the other senses go on."""


class BusError(LumenError):
    """The bus can't be used, or does not take a message."""


class BusAddressError(BusError):
    """The address of the bus, or a file of credentials or certificates that it names, is none: mend it."""


class BusUnreachableError(BusError):
    """Nobody answers at the address, or no broker that Lumen can use: start it there, or try again later."""


class BusRefusedError(BusError):
    """What answers does not let us: wrong name, password or virtual host, a missing right, or another has the place.

    Trying again changes nothing.
    """


class BusClosedError(BusError):
    """The bus was closed, here or by the exhibition that it belonged to: connect anew.

    A broker that goes away raises nothing: an open bus comes back with it.
    """


class BusFullError(BusError):
    """So many messages that must arrive wait for the broker that no more are taken: send again later."""


class BadMessageError(BusError):
    """The body is no JSON data, too large, or against the schema of its route, or the key is too long: mend it."""


class Refused(LumenError):  # noqa: N818  a word to the bus, not an error of whoever hands the message over
    """Raised by a handler for a message that it can't use; the text says why.

    The bus answers a sender who wants an answer, and a broker puts the message aside, with the reason.
    """


class ModuleError(LumenError):
    """A module lacks what it works with, or can't use what it was sent; the tour goes on without it."""


class UndeliveredError(LumenError):
    """An alert did not arrive; `final` is whether trying again would change nothing."""

    def __init__(self, message: str, *, final: bool = False) -> None:
        super().__init__(message)
        self.final = final
