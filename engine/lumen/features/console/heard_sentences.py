"""Visitors' sentences without names, with the states that heard them and the row that matched."""

from collections.abc import Iterator
from typing import Any, NamedTuple

from lumen.insight.explaining.outlook import Running, running
from lumen.insight.explaining.sentences import explained
from lumen.insight.replay.replaying import ReplayedStep
from lumen.language.machines import MachineDefinition, rows_around
from lumen.statechart import Snapshot
from lumen.statechart.asking import unnamed
from lumen.talk.hearing import hearing_of

ELSE = "else"


class HearingState(NamedTuple):
    """An active state that heard a sentence: the innermost one with `hears` rows in its region."""

    behavior: str
    state: str


class HeardSentence(NamedTuple):
    """A sentence that active states heard."""

    text: str
    """The sentence without names."""
    language: str
    states: tuple[HearingState, ...]
    """The states that heard it."""
    row: str
    """The key of the row that matched; empty if none did."""

    @property
    def understood(self) -> bool:
        return self.row not in ("", ELSE)

    def to_json(self) -> dict[str, Any]:
        return {**self._asdict(), "states": [[*one] for one in self.states]}


def heard_sentence(behavior: str, taken: ReplayedStep, text: str) -> tuple[HeardSentence, dict[str, list[str]]] | None:
    """Return a heard sentence without names, and the keys of the rows of each state that heard it.

    Return None if no active state has rows, the behaviour is unknown, or the sentence consists of names only.

    Names in the behaviours' context before or after the sentence are removed. Guards are evaluated with the context
    before it.
    """
    machine, before = taken.machine, taken.before
    if machine is None or before is None:
        return None
    rows: dict[HearingState, list[str]] = {}
    took = ""
    for name, one in _named(behavior, machine, before):
        for path in _hearing_paths(one) if hearing_of(one.machine).rows else ():
            sentence = explained(one.machine, path, text, one.snapshot.context, before.language)
            if sentence.taken and took in ("", ELSE):
                took = sentence.taken.key
            keys = dict.fromkeys(row.key for row in rows_around(one.machine, path))
            rows[HearingState(name, one.machine.states[path].name)] = list(keys)
    said = " ".join(_without_names(text, machine, before, taken.after).split())
    if not rows or not any(sign.isalnum() for sign in said):
        return None
    return HeardSentence(said, before.language, tuple(rows), took), {" ".join(one): keys for one, keys in rows.items()}


def _named(behavior: str, machine: MachineDefinition, snapshot: Snapshot) -> Iterator[tuple[str, Running]]:
    """Yield each running behaviour with its file's name."""
    names, waiting = {id(machine): behavior}, [machine]
    while waiting:
        for name, inner in waiting.pop().invoked.items():
            if id(inner) not in names:
                names[id(inner)] = name
                waiting.append(inner)
    for one in running(machine, snapshot):
        yield names[id(one.machine)], one


def _hearing_paths(one: Running) -> Iterator[str]:
    """Yield, for each active region, the path of the innermost active state that has rows."""
    states = one.machine.states
    active = [path for path, state in states.items() if state.name in one.snapshot.configuration or not path]
    outer = {states[path].parent for path in active}
    found: dict[str, None] = {}
    for leaf in (path for path in active if path not in outer):
        at: str | None = leaf
        while at is not None and not any(t.hears for t in states[at].transitions):
            at = states[at].parent
        if at is not None:
            found[at] = None
    yield from found


def _without_names(text: str, machine: MachineDefinition, *snapshots: Snapshot | None) -> str:
    for snapshot in filter(None, snapshots):
        for one in running(machine, snapshot):
            text = unnamed(text, one.snapshot.context)
    return text
