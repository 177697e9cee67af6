"""What a visit is: from the step by which the behaviour leaves its home until the one by which it is back.

Home is the innermost state in which a behaviour begins; where there are regions, that of the first one, in the order of
the file. It is where `lumen test --explore` looks for a way back to.
"""

from collections.abc import Iterable, Iterator, Mapping
from typing import NamedTuple

from lumen.errors import LumenError
from lumen.interpreters.replay.entries import JournalInput, JournalJump, RecordedEntry
from lumen.interpreters.statechart import initial
from lumen.language.machines import MachineDefinition, StateKind


class RecordedVisit(NamedTuple):
    """The entries from `first` to `last` of a journal, by their positions, and when they were [s since 1970, in UTC].

    `whole` is whether the behaviour came back home; `redacted` whether somebody was named in it who is forgotten.
    `bundle` ran when it began.
    """

    number: int
    first: int
    last: int
    began: float
    ended: float
    bundle: str
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
        self._home, self.away, self.epoch, self.bundle = "", False, 0.0, ""

    def take(self, entry: RecordedEntry, machine: MachineDefinition | None) -> bool:
        """Whether the entry is part of a visit; `away` is then whether that goes on. `machine` is the one that runs."""
        before = self.away
        match entry:
            case JournalJump(bundle=bundle, behavior=behavior, snapshot=snapshot):
                self.bundle = bundle
                if machine and (bundle, behavior) not in self._homes:
                    self._homes[bundle, behavior] = home_of(machine)
                self._home = self._homes.get((bundle, behavior), "")
                if isinstance(snapshot, Mapping):
                    self.epoch = snapshot.get("epoch", self.epoch)
                    self.away = bool(self._home) and self._home not in snapshot.get("configuration", ())
                if entry.kind in ("start", "resume"):
                    return self.away
            case JournalInput(event=event, exited=exited, entered=entered):
                if event.name == event.sendid == "clock set" and isinstance(event.data, Mapping):
                    self.epoch = event.data.get("epoch", self.epoch)
                if self._home and self._home in entered:
                    self.away = False
                elif self._home and self._home in exited:
                    self.away = True
        return before or self.away


def visits(entries: Iterable[tuple[RecordedEntry, MachineDefinition | None]]) -> Iterator[RecordedVisit]:
    """The visits in a journal, each as it ends; the last may not be `whole`."""
    watch, current, number = VisitWatch(), None, 0
    for entry, machine in entries:
        part = watch.take(entry, machine)
        at = watch.epoch + (entry.at if isinstance(entry, JournalJump) else entry.event.at)
        if current and (not part or (isinstance(entry, JournalJump) and entry.kind == "start")):
            yield current
            current = None
        if part and current is None:
            number += 1
            current = RecordedVisit(number, entry.position, entry.position, at, at, watch.bundle)
        if current:
            current = current._replace(last=entry.position, ended=at, redacted=current.redacted or entry.redacted)
            if not watch.away:
                yield current._replace(whole=True)
                current = None
    if current:
        yield current
