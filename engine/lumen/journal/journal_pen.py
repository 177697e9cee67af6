"""Turns steps and jumps of a running behaviour into lines of its journal."""

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
"""The time between two keyframes [s of the exhibition]; a return to the waiting state also writes one."""

LARGE = 50_000
"""A keyframe larger than this [bytes] is written only after entries of at least the same size in total.

So a behaviour with much memory that returns to its waiting state with each step does not fill the disk.
"""

NO_JSON = (TypeError, ValueError, RecursionError)
"""The errors raised for data that JSON cannot represent."""


class Stepped(NamedTuple):
    """A step of the behaviour, and the kind of its input."""

    step: Step
    how: How


class Jumped(NamedTuple):
    """A change of the behaviour's state without a step."""

    kind: JumpKind
    project: Project
    snapshot: Snapshot
    commands: Sequence[Command]
    said: dict[str, Any]


class JournalPen:
    """Encodes entries, and remembers the behaviour's state after the last entry."""

    def __init__(self) -> None:
        self._digest = StepDigest()
        self._project: Project | None = None
        self._snapshot: Snapshot | None = None
        self._home, self._kept = "", 0.0
        self._large, self._since = 0, 0

    @property
    def bundle(self) -> str:
        """The hash of the files that run, empty before the first entry."""
        return self._project.hash if self._project else ""

    def write(self, told: Stepped | Jumped) -> list[bytes]:
        """Return the lines of an entry, and of the keyframe after it if one is due."""
        return self._stepped(*told) if isinstance(told, Stepped) else self._jumped(told)

    def keyframe(self, *, gone: int = 0) -> list[bytes]:
        """Return the behaviour's state as a keyframe, or as a gap after `gone` lost entries; empty if it is unknown."""
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
