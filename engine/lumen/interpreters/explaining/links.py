"""One link of the chain that leads from something that happened to what caused it."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import UTC, datetime
from typing import Any, Literal

from lumen.language.diagnostics import Place

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
            "at": utc(self.at),
            "file": self.place.file if self.place else None,
            "line": self.place.line if self.place else None,
            "id": self.id,
            "values": dict(self.values),
        }


def utc(at: float) -> str:
    """`2026-11-22T18:00:00.000Z` for a time [s since 1970]."""
    return datetime.fromtimestamp(at, UTC).isoformat(timespec="milliseconds").replace("+00:00", "Z")
