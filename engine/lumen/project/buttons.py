"""The `buttons` of a state, from their plain data."""

from collections.abc import Mapping
from typing import Any

from lumen.language.buttons import Button
from lumen.language.diagnostics import NodePath


def buttons(data: Any, where: NodePath) -> tuple[Button, ...]:
    """Those that can be read, in the order of the file."""
    rows = ((row, (*where, number)) for number, row in enumerate(data or ()))
    return tuple(
        Button(
            label=_label(row["label"]),
            event=row["event"],
            data=row.get("data"),
            confirm=row.get("confirm", ""),
            key=str(row.get("key", "")),
            where=place,
        )
        for row, place in rows
        if isinstance(row, Mapping) and row.get("label") and row.get("event")
    )


def _label(texts: Any) -> dict[str, str]:
    """By language; what is the same in all is under the empty one."""
    table = {"": texts} if isinstance(texts, str) else texts
    return {"" if language == "any" else language: str(text) for language, text in table.items()}
