"""The `buttons` of a state, from their plain data."""

from collections.abc import Mapping
from typing import Any

from lumen.language.buttons import Button
from lumen.language.diagnostics import NodePath
from lumen.project.field_reader import read_fields


def buttons(data: Any, where: NodePath) -> tuple[Button, ...]:
    """Those that can be read, in the order of the file."""
    rows = ((row, (*where, number)) for number, row in enumerate(data or ()))
    return tuple(
        read_fields(Button, row, label=_label(row["label"]), key=str(row.get("key", "")), where=place)
        for row, place in rows
        if isinstance(row, Mapping) and row.get("label") and row.get("event")
    )


def _label(texts: Any) -> dict[str, str]:
    """By language; what is the same in all is under the empty one."""
    table = {"": texts} if isinstance(texts, str) else texts
    return {"" if language == "any" else language: str(text) for language, text in table.items()}
