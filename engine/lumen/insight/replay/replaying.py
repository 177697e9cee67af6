"""Replays a journal: takes its steps again, and compares them with the record."""

import json
from collections.abc import Callable, Iterable, Iterator
from typing import Any, NamedTuple

from lumen.errors import LumenError, SnapshotError
from lumen.insight.replay.digest import StepDigest
from lumen.insight.replay.entries import JournalInput, JournalJump, RecordedEntry
from lumen.language.causes import Cause
from lumen.language.command_data import command_data
from lumen.language.machines import MachineDefinition
from lumen.statechart import Snapshot, Step, deserialize, due, initial, serialize, step
from lumen.statechart.direct_entry import entered_directly

MachineSource = Callable[[str, str], MachineDefinition | None]
"""A function that returns the machine of a behaviour in the bundle with a hash; None if it was not kept."""


class StepOutcome(NamedTuple):
    """The result of a step, as recorded or as replayed; `str` returns it in words."""

    exited: tuple[str, ...]
    """The names of the states that were left."""
    entered: tuple[str, ...]
    """The names of the states that were entered."""
    commands: tuple[Any, ...]
    """The commands as JSON data."""
    digest: str = ""
    """The digest of the step."""
    trouble: str = ""
    """The error if the step could not be taken; empty if it could."""

    def __str__(self) -> str:
        if self.trouble:
            return self.trouble
        ways = [f"leaves {', '.join(self.exited)}"] if self.exited else []
        ways += [f"enters {', '.join(self.entered)}"] if self.entered else []
        ways += [json.dumps(command, ensure_ascii=False) for command in self.commands]
        return "; ".join(ways) or f"changes no state and sends no command ({self.digest})"


class ReplayedStep(NamedTuple):
    """An entry with its step taken again."""

    entry: RecordedEntry
    """The recorded entry."""
    machine: MachineDefinition | None = None
    """The machine that ran; None if its files were not kept."""
    before: Snapshot | None = None
    """The snapshot from which the step was taken."""
    step: Step | None = None
    """The step; None for a jump that is not a start, or if it could not be taken."""
    was: StepOutcome | None = None
    """The recorded result; None if there is nothing to compare."""
    now: StepOutcome | None = None
    """The result of the replay; None if there is nothing to compare."""
    unknown: str = ""
    """Why the step can't be taken: the state is unknown, or a visitor's data was deleted; empty if it can."""

    @property
    def differs(self) -> bool:
        """Whether the replay differs from the record."""
        return self.was != self.now

    @property
    def after(self) -> Snapshot | None:
        """The snapshot after the step; None if it is unknown."""
        return self.step.snapshot if self.step else self.before


def replay(entries: Iterable[RecordedEntry], machines: MachineSource) -> Iterator[ReplayedStep]:
    """Yield each entry with its step, taken again with the bundle that ran then.

    A difference causes further differences until the next keyframe with a snapshot.
    """
    replayer = Replayer(machines)
    for entry in entries:
        yield replayer.take(entry)


class Replayer:
    """Replays a journal, entry by entry."""

    def __init__(self, machines: MachineSource) -> None:
        self._machines, self._digest = machines, StepDigest()
        self._machine: MachineDefinition | None = None
        self._snapshot: Snapshot | None = None
        self._unknown = "the journal does not contain the time before it"

    def take(self, entry: RecordedEntry) -> ReplayedStep:
        """Replay the next entry and return the result.

        Faulty content of the journal raises no error: `unknown` or `now` of the result reports it.
        """
        return self._step(entry) if isinstance(entry, JournalInput) else self._jump(entry)

    def _step(self, entry: JournalInput) -> ReplayedStep:
        machine, before = self._machine, self._snapshot
        if entry.redacted:
            self._lose("an entry names a visitor whose data was deleted")
        if machine is None or before is None or entry.redacted:
            return ReplayedStep(entry, machine, unknown=self._unknown)
        was = StepOutcome(entry.exited, entry.entered, entry.commands, entry.digest)
        try:
            taken = _taken(machine, before, entry)
        except LumenError as error:
            return ReplayedStep(entry, machine, before, None, was, StepOutcome((), (), (), trouble=str(error)))
        self._snapshot = taken.snapshot
        return ReplayedStep(entry, machine, before, taken, was, self._outcome(taken))

    def _outcome(self, taken: Step) -> StepOutcome:
        commands = tuple(command_data(command) for command in taken.commands)
        return StepOutcome(taken.exited, taken.entered, commands, self._digest(taken))

    def _jump(self, entry: JournalJump) -> ReplayedStep:
        before = self._snapshot if entry.kind == "keyframe" else None
        self._machine = machine = self._machines(entry.bundle, entry.behavior)
        if machine is None:
            self._lose(f"the files of the bundle {entry.bundle[:16]} were not kept")
            return ReplayedStep(entry, unknown=self._unknown)
        if entry.snapshot is None:
            self._lose("the behaviour's state could not be written to the journal")
            return ReplayedStep(entry, machine, unknown=self._unknown)
        try:
            stands = deserialize(machine, entry.snapshot)
        except SnapshotError as error:
            self._lose(str(error))
            return ReplayedStep(entry, machine, unknown=self._unknown)
        if entry.kind == "start" and "arguments" in entry.said and not entry.redacted:
            self._snapshot = stands
            return self._began(entry, machine, entry.said["arguments"])
        if before is None or entry.redacted:
            self._snapshot = stands
            return ReplayedStep(entry, machine, stands)
        was, now = _standing(entry.snapshot, serialize(machine, before))
        if was != now:
            self._snapshot = stands
        return ReplayedStep(entry, machine, stands, None, was, now)

    def _began(self, entry: JournalJump, machine: MachineDefinition, said: dict[str, Any]) -> ReplayedStep:
        try:
            taken = initial(machine, **said)
        except (LumenError, TypeError) as error:
            return ReplayedStep(
                entry, machine, None, None, StepOutcome((), (), ()), StepOutcome((), (), (), trouble=str(error))
            )
        was, now = _standing(entry.snapshot, serialize(machine, taken.snapshot))
        commands = tuple(map(command_data, taken.commands))
        return ReplayedStep(
            entry, machine, None, taken, was._replace(commands=entry.commands), now._replace(commands=commands)
        )

    def _lose(self, why: str) -> None:
        self._snapshot, self._unknown = None, why


def _taken(machine: MachineDefinition, before: Snapshot, entry: JournalInput) -> Step:
    """Return the step of an entry. Raises LumenError if it can't be taken."""
    event = entry.event
    if entry.how == "heard":
        return step(machine, before, event)
    if entry.how == "goto":
        wanted = event.data.get("state") if isinstance(event.data, dict) else None
        return entered_directly(machine, before, str(wanted), event)
    timer = due(before)
    if timer is None or timer.sendid != event.sendid:
        raise LumenError(f"the timer `{event.name}` does not end at that time")
    taken = step(machine, before, timer)
    return taken._replace(event=timer._replace(cause=Cause("timer", timer.sendid)))


def _standing(was: Any, now: Any) -> tuple[StepOutcome, StepOutcome]:
    """Return the differences between two frozen snapshots as two outcomes, which are equal if the snapshots are."""
    was, now = json.loads(json.dumps(was)), json.loads(json.dumps(now))
    keys = [key for key in {**was, **now} if was.get(key) != now.get(key)]
    told = [", ".join(f"{key} {json.dumps(one.get(key), ensure_ascii=False)}" for key in keys) for one in (was, now)]
    return StepOutcome((), (), (), trouble=told[0]), StepOutcome((), (), (), trouble=told[1])
