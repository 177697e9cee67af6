"""The buttons of a state, from plain data."""

from collections.abc import Mapping
from typing import Any, NamedTuple

from lumen.language.buttons import Button, button_events
from lumen.language.diagnostics import NodePath
from lumen.project.field_reader import read_fields


class ReadButton(NamedTuple):
    """A button, and the data of its actions, None if the behaviour waits for its event elsewhere."""

    button: Button
    actions: Any = None


def read_buttons(data: Any, where: NodePath, state: str) -> tuple[ReadButton, ...]:
    """Return the buttons that can be read, in the order of the file; `state` is the name of their state."""
    rows = [row if isinstance(row, Mapping) and row.get("label") else {} for row in data or ()]
    labels = [_label(row.get("label", "")) for row in rows]
    own = button_events(state, labels)
    found = []
    for number, (row, label) in enumerate(zip(rows, labels, strict=True)):
        event = row.get("event") or ("actions" in row and own[number])
        if row and event:
            key, place = str(row.get("key", "")), (*where, number)
            button = read_fields(Button, {**row, "event": event}, label=label, key=key, where=place)
            found.append(ReadButton(button, row.get("actions")))
    return tuple(found)


def _label(texts: Any) -> dict[str, str]:
    """By language; a text that is the same in all is under the empty one."""
    table = {"": texts} if isinstance(texts, str) else texts
    return {"" if language == "any" else language: str(text) for language, text in table.items()}
