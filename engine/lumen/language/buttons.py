"""The buttons that an operator can press while a state is active."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Literal

from lumen.language.diagnostics import NodePath

Confirmation = Literal["hold", "ask", ""]


@dataclass(frozen=True, slots=True)
class Button:
    """A button that raises an event while its state, or a state within, is active.

    A button with `actions` in the file raises an event that `button_events` names.
    """

    label: Mapping[str, str]
    """The button's texts by language; a text that serves all languages has the empty code."""
    event: str
    data: Any = None
    confirm: Confirmation = ""
    """`hold` if the button must be held down, `ask` if the press must be confirmed, empty for neither."""
    key: str = ""
    """The key on the keyboard that presses the button; empty for none."""
    where: NodePath = field(default=(), compare=False)

    def named(self, name: str) -> bool:
        """Return True if the button has this name in one of its languages, in upper or lower case."""
        return any(text.casefold() == name.strip().casefold() for text in self.label.values())

    def replaces(self, other: "Button") -> bool:
        """Return True if this button replaces one of an outer state, with the same label or key, or event and data."""
        same = (self.event, self.data) == (other.event, other.data)
        return same or self.label == other.label or bool(self.key and self.key == other.key)


def button_events(state: str, labels: Sequence[Mapping[str, str]]) -> tuple[str, ...]:
    """Return an event for each button of a state, `button.STATE.LABEL`, for buttons that name none themselves.

    The label is in lower case, with `_` for other characters. A number makes equal names different, and replaces an
    empty label.
    """
    found: list[str] = []
    for number, label in enumerate(labels, 1):
        text = re.sub(r"\W+", "_", next(iter(label.values()), "").casefold()).strip("_")
        event = f"button.{state}.{text or number}"
        found.append(f"{event}_{number}" if event in found else event)
    return tuple(found)
