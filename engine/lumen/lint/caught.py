"""The JSON Schema of `heard` in a row of `hears`: the text, and the values that the slots of its phrases catch."""

from collections.abc import Iterator, Mapping
from typing import Any

from lumen.expressions import schema_of
from lumen.expressions.lists import is_text_by_language
from lumen.language.machines import Hears, MachineDefinition
from lumen.lint.lists import entry_schema
from lumen.talk.patterns import TYPES, PatternError, Slot, forms, read_pattern

_TEXT: Mapping[str, Any] = {"type": "string"}


def caught_schema(machine: MachineDefinition, row: Hears) -> dict[str, Any]:
    """The JSON Schema of `heard` in a row; a slot that not every form has is not required.

    It is empty for a row with phrases of an entry, and for one with a broken phrase, which is reported there.
    """
    phrases = [phrase for _, phrase in row_phrases(machine, row)]
    if any("." in name for name in row.names) or any(is_broken(machine, phrase) for phrase in phrases):
        return {}
    slots: dict[str, list[Mapping[str, Any]]] = {}
    several = [found for phrase in phrases for found in _slots(phrase)]
    for found in several:
        for slot in found:
            slots.setdefault(slot.name, []).append(_slot_schema(machine, slot))
    properties = {"text": _TEXT, "phrase": _TEXT, "answer": _answer_schema(machine, row)}
    properties |= {name: _joined(schemas) for name, schemas in slots.items()}
    everywhere = [name for name, schemas in slots.items() if len(schemas) == len(several)]
    return {"type": "object", "properties": properties, "required": ["text", "phrase", "answer", *everywhere]}


def row_phrases(machine: MachineDefinition, row: Hears) -> Iterator[tuple[str, str]]:
    """Every phrase of a row with its language."""
    for name in row.names:
        tables = [machine.phrases.get(name, {}), *(answer.phrases for answer in machine.answers.get(name, ()))]
        yield from ((language, text) for table in tables for language, texts in table.items() for text in texts)


def is_broken(machine: MachineDefinition, phrase: str) -> bool:
    """Whether a phrase has a slot that can't be read, or that can catch nothing."""
    if "{" not in phrase:
        return False
    try:
        found = {part for form in read_pattern(phrase) for part in form.parts if isinstance(part, Slot)}
    except PatternError:
        return True
    return any(slot.type not in TYPES and slot.type not in machine.lists for slot in found)


def _slots(phrase: str) -> Iterator[tuple[Slot, ...]]:
    """The slots of each form of a phrase; one without any counts once."""
    if "{" not in phrase:
        yield ()
    else:
        yield from (tuple(dict.fromkeys(p for p in form.parts if isinstance(p, Slot))) for form in forms(phrase))


def _slot_schema(machine: MachineDefinition, slot: Slot) -> Mapping[str, Any]:
    match slot.type:
        case "name" | "name?" | "text":
            return _TEXT
        case "number":
            return {"type": "number"}
        case kind if kind in machine.lists:
            return entry_schema(machine.lists[kind])
    return {}


def _joined(schemas: list[Mapping[str, Any]]) -> Mapping[str, Any]:
    """The schema of a slot that several forms have; empty if they differ."""
    return schemas[0] if all(schema == schemas[0] for schema in schemas) else {}


def _answer_schema(machine: MachineDefinition, row: Hears) -> Mapping[str, Any]:
    """The schema of `heard.answer`: null if no name of the row is one of `answers`."""
    values = [answer.value for name in row.names for answer in machine.answers.get(name, ())]
    kinds = {"string" if is_text_by_language(value) else schema_of(value)["type"] for value in values}
    if any(name not in machine.answers for name in row.names) or not values:
        kinds.add("null")
    return {"type": sorted(kinds)}
