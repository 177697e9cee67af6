"""What a visit is: from the step by which the behaviour leaves its home until the one by which it is back.

Home is the innermost state in which a behaviour begins; where there are regions, that of the first one, in the order of
the file. It is where `lumen test --explore` looks for a way back to.
"""

from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

from lumen.errors import LumenError
from lumen.insight.replay.entries import JournalInput, JournalJump, RecordedEntry
from lumen.insight.replay.journal_clock import JournalClock
from lumen.language.machines import MachineDefinition, StateKind
from lumen.statechart import initial

DROPPED = "dropped timer"
"""After it timers may be overdue, which then come in an order that no files would repeat."""
BROKEN = ("start", "gap", DROPPED)
"""Jumps before which something is missing, another run was, or what no files would do again."""


class RecordedVisit(NamedTuple):
    """A visit, and when it was [s since 1970, in UTC]; `first` and `last` are the positions of its entries.

    `whole` is whether the behaviour came back home, with nothing missing between; `redacted` whether somebody was named
    in it who is forgotten. `home` says where the behaviour stood before: at home, or where a run began that does not
    begin there, as that of a museum which is open already. It is None where that is not in the journal, and `inputs`
    are what happened from that moment on.
    """

    number: int
    first: int
    last: int
    began: float
    ended: float
    home: JournalJump | None = None
    inputs: tuple[JournalInput, ...] = ()
    whole: bool = False
    redacted: bool = False


def home_of(machine: MachineDefinition) -> str:
    """The name of the state in which the behaviour waits for a visitor, empty where it can't begin."""
    try:
        active, path = initial(machine).snapshot.configuration, ""
    except LumenError:
        return ""
    while children := machine.states[path].children:
        inner = [child for child in children if machine.states[child].kind is not StateKind.HISTORY]
        path = next((child for child in inner if machine.states[child].name in active), "")
        if not path:
            break
    return machine.states[path].name


class VisitWatch:
    """Says of one entry after another to which visit it belongs."""

    def __init__(self) -> None:
        self._homes: dict[tuple[str, str], str] = {}
        self._home, self.away, self.bundle = "", False, ""
        self._clock = JournalClock()
        self.at = 0.0

    def take(self, entry: RecordedEntry, machine: MachineDefinition | None) -> bool:
        """Whether the entry is part of a visit; `away` is then whether that goes on. `machine` is the one that runs.

        `at` is when it was made [s since 1970, in UTC].
        """
        before, self.at = self.away, self._clock.of(entry)
        match entry:
            case JournalJump(bundle=bundle, behavior=behavior, snapshot=snapshot):
                self.bundle = bundle
                if machine and (bundle, behavior) not in self._homes:
                    self._homes[bundle, behavior] = home_of(machine)
                self._home = self._homes.get((bundle, behavior), "")
                if isinstance(snapshot, Mapping):
                    self.away = bool(self._home) and self._home not in snapshot.get("configuration", ())
                if entry.kind in ("start", "resume"):
                    return self.away
            case JournalInput(exited=exited, entered=entered):
                if self._home:  # one step may leave it and enter it several times
                    self.away = (not self.away) + entered.count(self._home) - exited.count(self._home) < 1
        return before or self.away


def visits(entries: Iterable[tuple[RecordedEntry, MachineDefinition | None]]) -> Iterator[RecordedVisit]:
    """The visits in a journal, each as it ends; the last may not be `whole`. With each entry comes what ran then."""
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
