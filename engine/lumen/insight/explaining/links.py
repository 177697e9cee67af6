"""One link of the chain that leads from something that happened to what caused it."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Literal

from lumen.language.diagnostics import Place
from lumen.language.iso_time import iso_time

LinkKind = Literal["command", "activity", "transition", "event", "timer", "message", "person", "file", "start"]


@dataclass(frozen=True, slots=True)
class Link:
    """What happened at `at` [s since 1970, in UTC], in words, and where the files say so.

    `id` is that of a command, a timer or a message; `values` are those that decided it: of a guard's parts, or what an
    event brought. `number` is that of the recorded step.
    """

    kind: LinkKind
    text: str
    at: float
    place: Place | None = None
    id: str = ""
    values: Mapping[str, Any] = field(default_factory=dict)
    number: int = 0

    def to_json(self) -> dict[str, Any]:
        """The object of `lumen why --format json`."""
        return {
            "kind": self.kind,
            "text": self.text,
            "at": iso_time(self.at),
            "file": self.place.file if self.place else None,
            "line": self.place.line if self.place else None,
            "id": self.id,
            "values": dict(self.values),
        }
