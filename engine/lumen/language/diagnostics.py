"""What is wrong in somebody's file, where, and what would be right."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from enum import StrEnum
from typing import Any, NamedTuple, Protocol

Path = tuple[str | int, ...]
"""Where something stands in a document: keys and indices from its root, as in `("states", "idle", "on", 0)`."""


class Severity(StrEnum):
    ERROR = "error"
    WARNING = "warning"
    INFO = "info"


class Place(NamedTuple):
    """A span of a file, relative to the project; lines and columns count from 1, the end is exclusive."""

    file: str
    line: int = 1
    column: int = 1
    end_line: int = 1
    end_column: int = 1

    def __str__(self) -> str:
        return f"{self.file}:{self.line}:{self.column}"


class Places(Protocol):
    """A document that knows where its nodes stand."""

    def place(self, path: Path, *, key: bool = False) -> Place:
        """The place of the node at `path`, or of its key."""
        ...


class Related(NamedTuple):
    """Another place that explains a diagnostic ("first defined here")."""

    place: Place
    message: str


@dataclass(frozen=True, slots=True)
class Diagnostic:
    """One finding: a stable code, a message in the user's words, the place, and a hint at what would be right."""

    code: str
    message: str
    place: Place
    hint: str = ""
    severity: Severity = Severity.ERROR
    related: tuple[Related, ...] = ()

    def __str__(self) -> str:
        hint = f" ({self.hint})" if self.hint else ""
        return f"{self.place}: {self.severity} [{self.code}] {self.message}{hint}"

    def to_json(self) -> dict[str, Any]:
        """The object of `lumen lint --format json`."""
        return {
            "file": self.place.file,
            "line": self.place.line,
            "column": self.place.column,
            "end_line": self.place.end_line,
            "end_column": self.place.end_column,
            "code": self.code,
            "severity": str(self.severity),
            "message": self.message,
            "hint": self.hint,
            "related": [
                {"file": r.place.file, "line": r.place.line, "column": r.place.column, "message": r.message}
                for r in self.related
            ],
        }


def has_errors(diagnostics: Iterable[Diagnostic]) -> bool:
    """Whether any of them keeps the project from running."""
    return any(d.severity is Severity.ERROR for d in diagnostics)


def did_you_mean(word: object, candidates: Iterable[str], what: str = "") -> str:
    """The hint for an unknown name: the nearest candidate, else the list of all (`what`: "motions/ has")."""
    names: Sequence[str] = sorted(set(candidates))
    lowered = {name.lower(): name for name in names}
    near = [lowered[m] for m in get_close_matches(str(word).lower(), lowered, n=1, cutoff=0.6)]
    if near:
        return f"did you mean `{near[0]}`?"
    if not names:
        return f"{what} nothing".strip() if what else ""
    shown = ", ".join(f"`{n}`" for n in names[:8]) + (", …" if len(names) > 8 else "")
    return f"{what or 'known are'} {shown}"
