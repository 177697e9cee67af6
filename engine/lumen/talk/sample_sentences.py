"""Sentences that visitors may say: phrases with their slots filled, and sentences for a row of `hears`."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import chain, islice
from typing import Any, NamedTuple

from lumen.language.json_paths import value_at
from lumen.language.machines import Hears, MachineDefinition
from lumen.talk.finder import Languages
from lumen.talk.hearing import ENTRY, by_language, phrases_in
from lumen.talk.patterns import Slot, forms, written_forms
from lumen.talk.speech import NEGATIONS, NEGATIONS_AFTER, QUESTIONS

NONSENSE = ("lorem ipsum dolor sit amet", "")
"""Texts for which `else` is taken: they contain no phrase, and the first is too long for a name."""
SAMPLES: Mapping[str, tuple[str, Any]] = {
    "name": ("Budi", "Budi"),
    "name?": ("Budi", "Budi"),
    "number": ("3", 3),
    "text": ("something", "something"),
}
"""For each type of slots that is not a list: a text, and the value that the slot catches."""

_Lists = Mapping[str, Sequence[Mapping[str, Any]]]


class SampleSentence(NamedTuple):
    """A sentence in which a phrase is found, and the values that the slots catch."""

    text: str
    caught: Mapping[str, Any]


def of_phrase(phrase: str, lists: _Lists, literals: Sequence[Any] = ()) -> Iterator[SampleSentence]:
    """Yield a sentence for each form of a phrase, in the order written; none for a form with a list without phrases.

    With `literals` there are more sentences: with each literal in the slots that it fits, and with other entries of the
    lists.
    """
    for form in written_forms(phrase):
        slots = [part for part in form if isinstance(part, Slot)]
        samples = [list(_samples(slot, lists, literals)) for slot in slots]
        for number in range(max(map(len, samples), default=1) if all(samples) else 0):
            chosen = [found[min(number, len(found) - 1)] for found in samples]
            said = iter(chosen)
            words = (part if isinstance(part, str) else next(said)[0] for part in form)
            caught = {slot.name: value for slot, (_, value) in zip(slots, chosen, strict=True)}
            yield SampleSentence(" ".join(filter(None, words)).rstrip(" ."), caught)


def of_row(
    machine: MachineDefinition, row: Hears, context: Mapping[str, Any], literals: Sequence[Any] = ()
) -> Iterator[str]:
    """Yield sentences for which a row may be taken, the simplest first; another row of its state may match more words.

    `literals` are tried in its slots, too, because its guard may compare them with the words in the slots.
    """
    if row.way == "else":
        yield from NONSENSE
        return
    tables = [table for name in row.names for table in _tables(machine, name, context)]
    seen: set[str] = set()
    for first in (True, False):
        for table in tables:
            for language, phrases in table.items():
                for phrase in phrases[:1] if first else phrases[1:]:
                    for sentence in of_phrase(phrase, machine.lists, literals):
                        if sentence.text not in seen:
                            seen.add(sentence.text)
                            yield from _in_way(machine, row.way, language, sentence.text)


def _tables(machine: MachineDefinition, name: str, context: Mapping[str, Any]) -> Iterator[Languages]:
    """Yield the tables of a name's phrases, each by language."""
    if name.startswith(ENTRY):
        value = value_at(context, name.split(".")[1:])
        if isinstance(value, str | list | tuple | Mapping):
            yield by_language(value)
    elif name in machine.phrases:
        yield machine.phrases[name]
    else:
        yield from (row.phrases for row in machine.answers.get(name, ()))


def _in_way(machine: MachineDefinition, way: str, language: str, text: str) -> Iterator[str]:
    """Yield sentences with a text in the way that a row requires: as it is, negated, or within a question."""
    if way == "":
        yield text
    elif way == "not":
        yield from (f"{word} {text}" for word in _words(machine, NEGATIONS, language)[:2])
        yield from (f"{text} {word}" for word in _words(machine, NEGATIONS_AFTER, language)[:1])
    else:
        yield from (f"{word} {text}" for word in _words(machine, QUESTIONS, language)[:2])


def _words(machine: MachineDefinition, name: str, language: str) -> tuple[str, ...]:
    lists = machine.phrases.get(name, {})
    return lists.get(language) or tuple(chain.from_iterable(lists.values()))


def _samples(slot: Slot, lists: _Lists, literals: Sequence[Any]) -> Iterator[tuple[str, Any]]:
    """Yield texts for a slot, each with the value that it catches."""
    if slot.type in SAMPLES:
        yield SAMPLES[slot.type]
        kind = int if slot.type == "number" else str
        yield from ((str(value), value) for value in literals if type(value) is kind and value != "")
        return
    entries = lists.get(slot.type, ())
    found = ((text, entry) for entry in entries for text in _plain(phrases_in(entry), lists))
    yield from found if literals else islice(found, 1)


def _plain(table: Languages, lists: _Lists) -> Iterator[str]:
    """Yield the sentence of an entry's first phrase that has a form without slots, if there is one."""
    phrases = (phrase for several in table.values() for phrase in several if any(form.plain for form in forms(phrase)))
    yield from (next(of_phrase(phrase, lists)).text for phrase in islice(phrases, 1))
