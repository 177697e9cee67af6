"""What was told of a running behaviour, as lines of its journal."""

from collections.abc import Sequence
from typing import Any, NamedTuple

from lumen.errors import SnapshotError
from lumen.insight.replay.digest import StepDigest
from lumen.insight.replay.entries import How, JournalInput, JournalJump, JumpKind
from lumen.insight.replay.visits import waiting_state
from lumen.journal.journal_file import line_of
from lumen.language.command_data import command_data
from lumen.language.commands import Command
from lumen.language.projects import Project
from lumen.statechart import Snapshot, Step, serialize

KEYFRAME_PERIOD = 60.0
"""How often it is written where the behaviour stands [s of the exhibition], besides each time it has come home."""

LARGE = 50_000
"""A keyframe of more bytes is written only when as much has been written besides: a behaviour that comes home with each
step, and remembers much, fills no disk."""

NO_JSON = (TypeError, ValueError, RecursionError)
"""What is raised for data that JSON can't hold."""


class Stepped(NamedTuple):
    """A step that was taken."""

    step: Step
    how: How


class Jumped(NamedTuple):
    """Where the behaviour went on from, by no step."""

    kind: JumpKind
    project: Project
    snapshot: Snapshot
    commands: Sequence[Command]
    said: dict[str, Any]


class JournalPen:
    """Knows where the behaviour stands after all that was written."""

    def __init__(self) -> None:
        self._digest = StepDigest()
        self._project: Project | None = None
        self._snapshot: Snapshot | None = None
        self._home, self._kept = "", 0.0
        self._large, self._since = 0, 0

    @property
    def bundle(self) -> str:
        """The hash of the files that run, empty before anything was written."""
        return self._project.hash if self._project else ""

    def write(self, told: Stepped | Jumped) -> list[bytes]:
        """The lines of an entry, and of the keyframe that follows it where one is due."""
        return self._stepped(*told) if isinstance(told, Stepped) else self._jumped(told)

    def keyframe(self, *, gone: int = 0) -> list[bytes]:
        """Where the behaviour stands, empty where that is not known; a gap where entries are `gone` before it."""
        if self._project is None or self._snapshot is None:
            return []
        said = {"lost": gone} if gone else {}
        return self._jumped(Jumped("gap" if gone else "keyframe", self._project, self._snapshot, (), said))

    def _stepped(self, step: Step, how: How) -> list[bytes]:
        self._snapshot = step.snapshot
        if step.event is None:
            return []
        commands = tuple(map(command_data, step.commands))
        try:
            digest = self._digest(step)
            lines = [line_of(JournalInput(0, how, step.event, step.exited, step.entered, commands, digest))]
        except NO_JSON:
            return self.keyframe(gone=1)
        self._since += len(lines[0])
        home = self._home and self._home in step.entered
        if (home or step.snapshot.at - self._kept >= KEYFRAME_PERIOD) and self._since >= self._large:
            lines += self.keyframe()
        return lines

    def _jumped(self, told: Jumped) -> list[bytes]:
        kind, project, snapshot, commands, said = told
        if project is not self._project:
            self._project, self._home = project, waiting_state(project.machine)
        self._snapshot, self._kept = snapshot, snapshot.at
        try:
            frozen = serialize(project.machine, snapshot)
        except SnapshotError:
            frozen = None
        done = tuple(map(command_data, commands))
        entry = JournalJump(0, kind, snapshot.at, project.hash, project.behavior, frozen, done, said)
        try:
            line = line_of(entry)
        except NO_JSON:
            line = line_of(entry._replace(commands=(), said={}))
        self._since, self._large = 0, len(line) if len(line) > LARGE else 0
        return [line]
