"""Forks a journal at a moment with another event or other files, and compares the fork with the recorded course.

All other recorded events happen again at their times, as for a visit with other files.
"""

from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

from lumen.errors import LumenError
from lumen.insight.migration import MigrationPlan, plan
from lumen.insight.replay.against import Duration, OtherPlay
from lumen.insight.replay.entries import HOWS, JournalInput, JournalJump, RecordedEntry, entry_data
from lumen.insight.replay.replaying import Replayer
from lumen.language.command_data import command_data
from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.statechart import Snapshot, Step

ProjectSource = Callable[[str, str], Project | None]
"""A function that returns the bundle with a hash and a behaviour; None if it was not kept."""
MAX_STEPS = 200
"""The maximum number of recorded inputs that are followed, and of steps that are returned."""


class ForkedRun(NamedTuple):
    """A fork and the recorded course, both as entries from the fork on."""

    was: tuple[dict[str, Any], ...]
    """The recorded entries."""
    would: tuple[dict[str, Any], ...]
    """The entries of the fork."""
    trouble: str = ""
    """The error that ended the fork early; empty if there was none."""


def fork(
    entries: Sequence[RecordedEntry],
    position: int,
    bundles: ProjectSource,
    takes: Duration,
    *,
    event: Event | None = None,
    saved: Project | None = None,
    hurry: Callable[[], None] = lambda: None,
) -> ForkedRun:
    """Return the fork at the first event from that position on, up to the next jump; keyframes are skipped.

    `event` replaces that event; `saved` are other files. `takes` gives durations of commands that were not recorded;
    `hurry` is called at each step and can raise. Raises LumenError if there is no such event, or if the state of the
    behaviour before it is unknown.
    """
    number = next((n for n, entry in enumerate(entries) if entry.position >= position), len(entries))
    then = _inputs(entries[number:])
    if not then:
        raise LumenError(f"no event at or after position {position} can be changed")
    old, stands = _before(entries[: entries.index(then[0])], bundles)
    new = saved or old
    play = _Forked(new, takes, hurry)
    trouble = play.go_over(old, stands, then[0].event.at)
    if not trouble:
        first = then[0] if event is None else then[0]._replace(how="heard", event=event._replace(at=then[0].event.at))
        try:
            for entry in (first, *then[1:]):
                play.hear(entry)
        except LumenError as error:
            trouble = str(error)
    was = tuple({"position": entry.position, **entry_data(entry)} for entry in then)
    return ForkedRun(was, tuple(play.told), trouble)


def _inputs(entries: Sequence[RecordedEntry]) -> list[JournalInput]:
    """Return the successive inputs up to the next jump, without keyframes and redacted entries; at most MAX_STEPS."""
    found: list[JournalInput] = []
    for entry in entries:
        if len(found) >= MAX_STEPS or (isinstance(entry, JournalJump) and found and entry.kind != "keyframe"):
            break
        if isinstance(entry, JournalInput) and not entry.redacted:
            found.append(entry)
    return found


def _before(entries: Sequence[RecordedEntry], bundles: ProjectSource) -> tuple[Project, Snapshot]:
    """Return the files that ran and the snapshot after these entries. Raises LumenError if either is unknown."""
    jumps = [n for n, entry in enumerate(entries) if isinstance(entry, JournalJump) and entry.snapshot is not None]
    if not jumps:
        raise LumenError("the behaviour's state at that time is no longer in the journal")
    jump = entries[jumps[-1]]
    assert isinstance(jump, JournalJump)
    old = bundles(jump.bundle, jump.behavior)
    if old is None:
        raise LumenError(f"the files of the bundle {jump.bundle[:16]} were not kept")
    replayer, stands, why = Replayer(lambda _hash, _behavior: old.machine), None, ""
    for entry in entries[jumps[-1] :]:
        row = replayer.take(entry)
        stands, why = row.after, row.unknown
    if stands is None:
        raise LumenError(why or "the behaviour's state at that time is not known")
    return old, stands


class _Forked(OtherPlay):
    """A play that continues from a snapshot and records each step in `told`."""

    def __init__(self, project: Project, takes: Duration, hurry: Callable[[], None]) -> None:
        super().__init__(project, takes)
        self._hurry = hurry
        self.told: list[dict[str, Any]] = []

    def go_over(self, old: Project, stands: Snapshot, at: float) -> str:
        """Change to the files at that snapshot; return why that is impossible, or an empty text."""
        if self._project is old:
            self._stands = stands
            return ""
        planned = plan(old, self._project, stands, at=at, now=True)
        if not isinstance(planned, MigrationPlan):
            return f"these files can't continue from there: {planned.reason}"
        self._stands = planned.snapshot
        return ""

    def _take(self, taken: Step) -> None:
        self._hurry()
        super()._take(taken)
        if taken.event and len(self.told) < MAX_STEPS:
            how = "timer" if taken.event.sendid else "goto" if taken.event.name == "operator.goto" else HOWS[0]
            commands = tuple(map(command_data, taken.commands))
            self.told.append(entry_data(JournalInput(0, how, taken.event, taken.exited, taken.entered, commands)))
