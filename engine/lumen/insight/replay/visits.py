"""The extent of a visit: from the step by which the behaviour leaves its home to the step by which it returns.

Home is the innermost state in which a behaviour begins; with regions, the innermost state of the first region in the
file. `lumen test --explore` looks for a way back to the same state.
"""

from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

from lumen.errors import LumenError
from lumen.insight.replay.entries import JournalInput, JournalJump, RecordedEntry
from lumen.insight.replay.journal_clock import JournalClock
from lumen.language.machines import MachineDefinition
from lumen.statechart import initial

DROPPED = "dropped timer"
"""A jump after which timers may be overdue; their order of ending would not repeat with any files."""
BROKEN = ("start", "gap", DROPPED)
"""Jumps after which entries are missing, another run begins, or events come in an order that would not repeat."""


class RecordedVisit(NamedTuple):
    """A visit in a journal."""

    number: int
    """The visit's number in the journal, from 1."""
    first: int
    """The position of the visit's first entry."""
    last: int
    """The position of the visit's last entry."""
    began: float
    """The time at which the visit began [s since 1970, in UTC]."""
    ended: float
    """The time at which the visit ended [s since 1970, in UTC]."""
    home: JournalJump | None = None
    """The jump before the visit, with the behaviour at home; None if the journal lacks it.

    It can also be the start of a run that began elsewhere, as in a museum that is already open.
    """
    inputs: tuple[JournalInput, ...] = ()
    """The events from `home` on."""
    whole: bool = False
    """Whether the behaviour returned home and no entry is missing."""
    redacted: bool = False
    """Whether a visitor's data was deleted from the visit."""


def waiting_state(machine: MachineDefinition) -> str:
    """Return the name of the state in which the behaviour waits for a visitor; empty if it can't begin."""
    try:
        active, path = initial(machine).snapshot.configuration, ""
    except LumenError:
        return ""
    while children := machine.states[path].children:
        path = next((child for child in children if machine.states[child].name in active), "")
        if not path:
            break
    return machine.states[path].name


class VisitWatch:
    """Assigns entries to visits; pass each entry to `take` in order."""

    def __init__(self) -> None:
        self._homes: dict[tuple[str, str], str] = {}
        self._home, self.away, self.bundle = "", False, ""
        self._clock = JournalClock()
        self.at = 0.0

    def take(self, entry: RecordedEntry, machine: MachineDefinition | None) -> bool:
        """Return whether the entry is part of a visit; `machine` is the machine that runs, None if unknown.

        Afterwards `away` is whether the visit continues, and `at` is the time of the entry [s since 1970, in UTC].
        """
        before, self.at = self.away, self._clock.of(entry)
        match entry:
            case JournalJump(bundle=bundle, behavior=behavior, snapshot=snapshot):
                self.bundle = bundle
                if machine and (bundle, behavior) not in self._homes:
                    self._homes[bundle, behavior] = waiting_state(machine)
                self._home = self._homes.get((bundle, behavior), "")
                if isinstance(snapshot, Mapping):
                    self.away = bool(self._home) and self._home not in snapshot.get("configuration", ())
                if entry.kind in ("start", "resume"):
                    return self.away
            case JournalInput(exited=exited, entered=entered):
                if self._home:  # one step can leave home and enter it several times
                    self.away = (not self.away) + entered.count(self._home) - exited.count(self._home) < 1
        return before or self.away


def visits(entries: Iterable[tuple[RecordedEntry, MachineDefinition | None]]) -> Iterator[RecordedVisit]:
    """Yield the visits in a journal, each at its end; each entry is paired with the machine that ran.

    The last visit can be incomplete, that is, not `whole`.
    """
    watch, number = VisitWatch(), 0
    current: RecordedVisit | None = None
    home: JournalJump | None = None
    inputs = list[JournalInput]()
    for entry, machine in entries:
        part = watch.take(entry, machine)
        jump = entry if isinstance(entry, JournalJump) else None
        if current and (not part or (jump and jump.kind in BROKEN)):
            yield current._replace(home=home, inputs=tuple(inputs))
            current = None
        if jump and (jump.kind in BROKEN or not watch.away):
            known = jump.kind == "start" or (jump.kind != DROPPED and not watch.away)
            home, inputs = (jump if known else None), []
        elif isinstance(entry, JournalInput):
            inputs.append(entry)
        if part and current is None:
            number += 1
            current = RecordedVisit(number, entry.position, entry.position, watch.at, watch.at)
        if current:
            redacted = current.redacted or entry.redacted
            current = current._replace(last=entry.position, ended=watch.at, redacted=redacted)
            if not watch.away:
                yield current._replace(home=home, inputs=tuple(inputs), whole=True)
                current, home, inputs = None, None, []
    if current:
        yield current._replace(home=home, inputs=tuple(inputs))
