"""One link of the chain from an effect to its cause."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from lumen.language.diagnostics import Place
from lumen.language.iso_time import iso_time

LinkKind = Literal["command", "activity", "transition", "event", "timer", "message", "person", "file", "start"]


@dataclass(frozen=True, slots=True)
class Link:
    """Something that happened, as part of a chain of causes."""

    kind: LinkKind
    """The kind of link."""
    text: str
    """What happened, in words."""
    at: float
    """When it happened [s since 1970, in UTC]."""
    place: Place | None = None
    """The place in the files that defines it; None if there is none."""
    id: str = ""
    """The id of the command, timer or message; empty if it has none."""
    values: Mapping[str, Any] = field(default_factory=dict)
    """The values that decided it: those of the guard's parts, or the data of the event."""
    number: int = 0
    """The number of the recorded step."""

    def to_json(self) -> dict[str, Any]:
        """Return an entry of `chain` in the output of `lumen why --format json`."""
        return {
            "kind": self.kind,
            "text": self.text,
            "at": iso_time(self.at),
            "file": self.place.file if self.place else None,
            "line": self.place.line if self.place else None,
            "id": self.id,
            "values": dict(self.values),
        }
