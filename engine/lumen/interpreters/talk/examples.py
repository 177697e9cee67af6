"""Examples of what visitors may say: forms as texts, refusals, questions, and what no row hears."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

from lumen.interpreters.talk.hearing import Hearing, by_language
from lumen.interpreters.talk.patterns import Form, Slot, forms
from lumen.language.machines import Hears

NONSENSE = "qwe rty uio asd fgh jkl"
"""A sentence without any phrase; it has too many words for a name."""

_CAUGHT = {"name": "Ani", "name?": "Ani", "number": "7", "text": "something"}


def example(form: Form, lists: Mapping[str, Sequence[Mapping[str, Any]]]) -> str:
    """Return a form as a sentence, with an example in each of its slots."""
    return " ".join(_caught(part, lists) if isinstance(part, Slot) else part for part in form.parts)


def examples_of(hearing: Hearing, row: Hears, context: Mapping[str, Any]) -> Iterator[str]:
    """Return a sentence for each name of a row, which leads there unless a better row is found."""
    if row.way == "else":
        yield NONSENSE
        return
    before = {"not": _first(hearing.speech.negations.by_first), "asked": _first(hearing.speech.questions.by_first)}
    for name in row.names:
        if text := next(_texts(hearing, name, context), ""):
            yield f"{before.get(row.way, '')} {text}".strip()


def _texts(hearing: Hearing, name: str, context: Mapping[str, Any]) -> Iterator[str]:
    machine = hearing.machine
    for phrases in _tables(hearing, name, context):
        for texts in phrases.values():
            yield from (example(form, machine.lists) for text in texts for form in forms(text)[:1])


def _tables(hearing: Hearing, name: str, context: Mapping[str, Any]) -> Iterator[Mapping[str, Sequence[str]]]:
    machine = hearing.machine
    if name in machine.phrases:
        yield machine.phrases[name]
    elif name in machine.answers:
        yield from (row.phrases for row in machine.answers[name])
    elif (found := hearing.entry(name, context)) is not None:
        yield by_language(found)


def _caught(slot: Slot, lists: Mapping[str, Sequence[Mapping[str, Any]]]) -> str:
    entries = (by_language(entry.get("phrases") or ()) for entry in lists.get(slot.type, ()))
    texts = (text for table in entries for several in table.values() for text in several)
    return _CAUGHT.get(slot.type) or next(texts, slot.name)


def _first(words: Mapping[str, list[tuple[str, ...]]]) -> str:
    return " ".join(next(iter(words.values()))[0]) if words else ""
