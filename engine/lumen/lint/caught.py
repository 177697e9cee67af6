"""The JSON Schema of `heard` in a row of `hears`: the text, and the values that its slots catch."""

from collections.abc import Iterator, Mapping
from typing import Any

from lumen.expressions import schema_of
from lumen.expressions.lists import is_text_by_language
from lumen.language.machines import Hears, MachineDefinition
from lumen.lint.lists import entry_schema
from lumen.talk.patterns import TYPES, PatternError, Slot, forms, read_pattern

_TEXT: Mapping[str, Any] = {"type": "string"}


def caught_schema(machine: MachineDefinition, row: Hears) -> dict[str, Any]:
    """Return the JSON Schema of `heard` in a row; a slot that only some forms have is not required.

    The schema is empty if the row has phrases of a list's entries, or a broken phrase, which is reported elsewhere.
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
    """Yield the language and the text of every phrase of a row."""
    for name in row.names:
        tables = [machine.phrases.get(name, {}), *(answer.phrases for answer in machine.answers.get(name, ()))]
        yield from ((language, text) for table in tables for language, texts in table.items() for text in texts)


def is_broken(machine: MachineDefinition, phrase: str) -> bool:
    """Return whether a phrase can't be read, or has a slot of an unknown type."""
    if "{" not in phrase:
        return False
    try:
        found = {part for form in read_pattern(phrase) for part in form.parts if isinstance(part, Slot)}
    except PatternError:
        return True
    return any(slot.type not in TYPES and slot.type not in machine.lists for slot in found)


def _slots(phrase: str) -> Iterator[tuple[Slot, ...]]:
    """Yield the slots of each form of a phrase; a phrase without slots yields one empty tuple."""
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
    """Return the schema of a slot that several forms have; empty if their schemas differ."""
    return schemas[0] if all(schema == schemas[0] for schema in schemas) else {}


def _answer_schema(machine: MachineDefinition, row: Hears) -> Mapping[str, Any]:
    """Return the schema of `heard.answer`; it includes null if a name of the row has no table under `answers`."""
    values = [answer.value for name in row.names for answer in machine.answers.get(name, ())]
    kinds = {"string" if is_text_by_language(value) else schema_of(value)["type"] for value in values}
    if any(name not in machine.answers for name in row.names) or not values:
        kinds.add("null")
    return {"type": sorted(kinds)}
