"""What an operator may press while a state is active."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from lumen.language.diagnostics import NodePath

Confirmation = Literal["hold", "ask", ""]


@dataclass(frozen=True, slots=True)
class Button:
    """A button that raises an event while its state, or one within, is active.

    `label` has its texts by language; under the empty one stands what is the same in all. `confirm` is whether it has
    to be held down or asked for again, `key` the one key that presses it.
    """

    label: Mapping[str, str]
    event: str
    data: Any = None
    confirm: Confirmation = ""
    key: str = ""
    where: NodePath = field(default=(), compare=False)

    def named(self, name: str) -> bool:
        """Whether it is called so in one of its languages, however that is written."""
        return any(text.casefold() == name.strip().casefold() for text in self.label.values())

    def replaces(self, other: "Button") -> bool:
        """Whether it stands for another one further out: of the same label or key, or for the same event and data."""
        same = (self.event, self.data) == (other.event, other.data)
        return same or self.label == other.label or bool(self.key and self.key == other.key)
