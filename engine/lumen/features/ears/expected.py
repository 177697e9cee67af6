"""The sentences that visitors are likely to say: those that the active states hear, and those in stories."""

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from itertools import islice
from typing import Any, NamedTuple

from lumen.expressions.parser import parse_expression
from lumen.expressions.tree import FunctionCall, Literal, path_of, walk
from lumen.language.machines import MachineDefinition, State
from lumen.language.projects import Project
from lumen.language.stories import Speak
from lumen.statechart.nesting import resolutions
from lumen.talk.finder import Finder
from lumen.talk.folding import APOSTROPHES, folded, words
from lumen.talk.hearing import phrases_in
from lumen.talk.patterns import Slot, forms, slots_of
from lumen.talk.speech import TABLES, WORD_LISTS, Speech

MAX_SENTENCES = 1_000
"""The maximum number of sentences of one phrase: its forms, with the entries of lists in their slots."""
STORY_WEIGHT = 10
"""The weight of a story's sentence, counted in forms: stories show how people talk, but forms are far more numerous."""
_NO_MEANINGS = frozenset((*WORD_LISTS, *TABLES))
_ENTRY = "context."
_STRAIGHT = dict.fromkeys(map(ord, APOSTROPHES), "'")

PhraseLists = Mapping[str, Sequence[Mapping[str, Any]]]


class HeardName(NamedTuple):
    """The name of phrases, an answers table or an entry's field that a state hears."""

    machine: MachineDefinition
    name: str

    def phrases(self) -> list[str]:
        """Return the phrases of the name in all languages.

        For an entry's field these are the phrases of all entries, because any can be the current one.
        """
        machine, name = self
        tables: list[Any] = [machine.phrases.get(name), *(row.phrases for row in machine.answers.get(name, ()))]
        if name.startswith(_ENTRY):
            field = name.rpartition(".")[2]
            tables += [entry.get(field) for entries in machine.lists.values() for entry in entries]
        return list(dict.fromkeys(_texts(tables)))

    def finder(self) -> Finder:
        """Return a finder of the name's phrases, which need not be whole clauses."""
        machine, name = self
        lists = {key: [(phrases_in(entry), entry) for entry in entries] for key, entries in machine.lists.items()}
        return Finder(Speech(machine.phrases, machine.answers), {name: {"": self.phrases()}}, lists=lists)


def heard_names(project: Project, states: Collection[str] | None) -> list[HeardName]:
    """Return the names that the active states hear, in `hears` and in guards that call `heard` or `lookup`.

    `states` are the names of all active states, including enclosing ones. If it is None or has a name that the project
    lacks, all states of all behaviours count.
    """
    active = None if states is None else _active(project.machine, states)
    if active is None:
        active = [(machine, state) for machine in project.behaviors.values() for state in machine.states.values()]
    found = {(id(machine), name): HeardName(machine, name) for machine, state in active for name in _names(state)}
    return [one for one in found.values() if one.name not in _NO_MEANINGS]


def expected(project: Project, heard: Iterable[HeardName], own: Iterable[str] = ()) -> list[list[str]]:
    """Return sentences as lower-case words: forms of the `heard` names in all languages, stories' sentences, and `own`.

    `own` are texts that the robot says at the same time. More likely sentences are repeated.
    """
    phrases = ((phrase, one.machine.lists) for one in heard for phrase in one.phrases())
    found = dict.fromkeys(tuple(words) for phrase in phrases for words in islice(_sentences(*phrase), MAX_SENTENCES))
    steps = (step for story in project.stories.values() for step in story.steps)
    said = dict.fromkeys(_spoken(step.action.text) for step in steps if isinstance(step.action, Speak))
    return [list(words) for words in (*found, *(*said,) * STORY_WEIGHT, *map(_spoken, own)) if words]


def _active(machine: MachineDefinition, names: Collection[str]) -> list[tuple[MachineDefinition, State]] | None:
    """Return the states with these names and their machines' roots, each with its machine; None for an unknown name."""
    machines, active = {id(machine): machine}, {(id(machine), "")}
    for name in sorted(names):
        known = [(m, s.path) for m, local in resolutions(machine, name) for s in m.states.values() if s.name == local]
        if not known:
            return None
        machines |= {id(inner): inner for inner, _ in known}
        active |= {(id(inner), path) for inner, own in known for path in (own, "")}
    return [(m, state) for m in machines.values() for state in m.states.values() if (id(m), state.path) in active]


def _names(state: State) -> Iterator[str]:
    for transition in state.transitions:
        if transition.hears:
            yield from transition.hears.names
        if transition.guard:
            for node, _ in walk(parse_expression(transition.guard.source)):
                match node:
                    case FunctionCall("heard" | "lookup", (_, Literal(value=str() as name))):
                        yield name
                    case FunctionCall("heard", (_, other)) if path := path_of(other):
                        yield ".".join(path)


def _sentences(phrase: str, lists: PhraseLists) -> Iterator[list[str]]:
    """Yield the forms of a phrase as words, with the entries of lists in their slots; other slots are left out."""
    written = {"".join(folded(word)): word for word in _spoken(phrase)}
    entries = {slot: _entries(slot, lists) for slot in slots_of(phrase)}
    for form in forms(phrase):
        parts = [entries[p] if isinstance(p, Slot) else [[written.get(p, p)]] for p in form.parts]
        for i in range(max(map(len, parts))):
            yield [word for several in parts for word in several[i % len(several)]]


def _entries(slot: Slot, lists: PhraseLists) -> list[list[str]]:
    phrases = _texts([entry.get("phrases") for entry in lists.get(slot.type, ())])
    return [sentence for phrase in phrases for sentence in _sentences(phrase, {})] or [[]]


def _texts(value: Any) -> Iterator[str]:
    """Yield the texts in nested lists and maps."""
    match value:
        case str():
            yield value
        case Mapping():
            yield from _texts(list(value.values()))
        case list() | tuple():
            for one in value:
                yield from _texts(one)


def _spoken(text: str) -> tuple[str, ...]:
    return tuple(word.lower() for word in words(text.translate(_STRAIGHT)))
