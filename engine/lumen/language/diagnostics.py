"""Findings about a user's files: each has a message, a place and a hint at the remedy."""

import re
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field, replace
from difflib import get_close_matches
from enum import StrEnum
from typing import Any, NamedTuple, Protocol, Self

from lumen.language.counts import counted
from lumen.language.lookalikes import difference, typed

MIN_FINDINGS_FOR_ROOT = 8
"""The minimum number of findings with a common root for which one finding about the root replaces them."""

MAX_TEXT_CHARACTERS = 1_000
"""The maximum length of a message or hint [characters]; the middle of a longer one is left out."""

MAX_RELATED = 5
"""The number of places with the same cause that are shown besides the first."""

MAX_COMPARED_NAMES = 200
"""The maximum number of names that a misspelt one is compared with; of more, only similar ones are compared."""

MAX_CHANGED_LETTERS = 0.4
"""The maximum edit distance between a misspelt name and the right one, as a share of the longer one's letters."""

NodePath = tuple[str | int, ...]
"""The path of a node in a document: keys and indices from its root, as in `("states", "idle", "on", 0)`."""


class Severity(StrEnum):
    """The severity of a finding."""

    ERROR = "error"
    WARNING = "warning"
    INFO = "info"


ERROR, WARNING, INFO = Severity.ERROR, Severity.WARNING, Severity.INFO


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
    """A document with the places of its nodes."""

    def place(self, path: NodePath, *, key: bool = False) -> Place:
        """Return the place of the node at `path`, or of its key."""
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
    cause: str = field(default="", compare=False, repr=False)
    """A key for the mistake: findings with the same code and cause become one, see `gathered`."""
    root: str = field(default="", compare=False, repr=False)
    """The name of a likely mistake elsewhere that explains many findings: see `gathered`."""

    def __post_init__(self) -> None:
        for name, text in (("message", self.message), ("hint", self.hint)):
            if len(text) > MAX_TEXT_CHARACTERS:  # it quotes a file, and a word there may be as long as the file
                object.__setattr__(self, name, f"{text[:400]} … {text[-200:]}")

    def __str__(self) -> str:
        hint = f" ({self.hint})" if self.hint else ""
        return f"{self.place}: {self.severity} [{self.code}] {self.message}{hint}"

    def to_json(self) -> dict[str, Any]:
        """Return the diagnostic as an object in the output of `lumen lint --format json`."""
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


class Code(str):
    """A kind of finding. As a text it is its name; it also has its family, its severity and a one-line summary.

    Each is declared once, as a value next to the check that reports it. `lumen.lint.codes` collects them, and
    `lint/pages/CODE.md` explains why it matters and shows a wrong and a right example.
    """

    family: str
    severity: Severity
    summary: str

    def __new__(cls, name: str, family: str, severity: Severity, summary: str) -> Self:
        code = super().__new__(cls, name)
        code.family, code.severity, code.summary = family, severity, summary
        return code

    def __reduce__(self) -> tuple[type[Self], tuple[str, str, Severity, str]]:
        return type(self), (str(self), self.family, self.severity, self.summary)

    def at(
        self, place: Place, message: str, hint: str = "", related: tuple[Related, ...] = (), cause: str = ""
    ) -> Diagnostic:
        """Return a finding of this kind at that place."""
        return Diagnostic(self, message, place, hint, self.severity, related, cause)


def has_errors(diagnostics: Iterable[Diagnostic]) -> bool:
    """Return True if any of the findings prevents the project from running."""
    return any(d.severity is Severity.ERROR for d in diagnostics)


def gathered(diagnostics: Iterable[Diagnostic]) -> list[Diagnostic]:
    """Return the findings sorted by file and line; those with the same code and cause become one with related places.

    The one that stays is in a behaviour rather than in a story. Findings with the same code and root become one too if
    there are at least MIN_FINDINGS_FOR_ROOT of them, or if one of them has that root as its cause.
    """
    several = list(dict.fromkeys(diagnostics))
    causes = {(d.code, d.cause) for d in several}
    roots = Counter((d.code, d.root) for d in several)
    found: dict[tuple[str, str], list[Diagnostic]] = {}
    for diagnostic in several:
        code, root = diagnostic.code, diagnostic.root
        rooted = root if (code, root) in causes or roots[code, root] >= MIN_FINDINGS_FOR_ROOT else ""
        found.setdefault((code, rooted or diagnostic.cause or f"{len(found)}:"), []).append(diagnostic)
    return sorted(
        (_joined(group, cause, len(group) >= MIN_FINDINGS_FOR_ROOT) for (_, cause), group in found.items()), key=_order
    )


def _order(diagnostic: Diagnostic) -> tuple[Place, str, str]:
    return diagnostic.place, diagnostic.code, diagnostic.message


def _joined(findings: list[Diagnostic], cause: str, many: bool) -> Diagnostic:
    """Return the first finding with the others as related places; those beyond MAX_RELATED are only counted."""
    if len(findings) == 1:
        return findings[0]
    first, *others = sorted(findings, key=lambda d: (d.cause != cause, "/stories/" in d.place.file, _order(d)))
    shown = [Related(d.place, d.message if d.message != first.message else "and here") for d in others[:MAX_RELATED]]
    if left := len(others) - len(shown):
        shown[-1] = Related(shown[-1].place, f"and here, and in {counted(left, 'more place')}")
    if many and first.cause != cause == first.root:
        first = replace(first, hint=f"look at {cause} first: it causes the problem in {len(findings)} places")
    return replace(first, related=(*first.related, *shown))


def nearest(word: object, candidates: Iterable[str]) -> str:
    """Return the candidate that was probably meant by a misspelt word; empty if none is similar."""
    names = set(candidates)
    meant = typed(str(word))
    if meant != word and (equal := next((name for name in sorted(names) if typed(name) == meant), "")):
        return equal
    lowered = {name.lower(): name for name in sorted(_alike(str(word), names))}
    written = str(word).lower()
    for near in get_close_matches(written, lowered, n=3, cutoff=0.6):
        if _is_slip(written, near):
            return lowered[near]
    if anagram := next((n for n in lowered.values() if sorted(n) == sorted(str(word))), ""):
        return anagram
    parts = [part for part in re.split(r"[\W_]+", str(word).lower()) if len(part) > 3]
    return next((lowered[part] for part in parts if part in lowered), "")


def _is_slip(word: str, meant: str) -> bool:
    """Return True if few letters differ, or one begins or ends with the other; also for the last part of `meant`."""
    word, meant = word.lstrip("-"), meant.lstrip("-")  # the hyphens of options
    short, long = sorted((word, meant), key=len)
    if long.startswith(short) or long.endswith(short):
        return True
    if "." in meant and "." not in word and _is_slip(word, meant.rpartition(".")[2]):
        return True  # the last part of a name alone
    row = list(range(len(meant) + 1))  # Levenshtein's edit distance
    for i, letter in enumerate(word):
        before, row[0] = row[0], i + 1
        for j, other in enumerate(meant):
            before, row[j + 1] = row[j + 1], min(row[j + 1] + 1, row[j] + 1, before + (letter != other))
    return row[-1] <= max(2, MAX_CHANGED_LETTERS * max(len(word), len(meant)))


def _alike(word: str, names: set[str]) -> set[str]:
    """Return these names; if there are very many, those of similar length with the first or last letter of the word."""
    if len(names) <= MAX_COMPARED_NAMES:
        return names
    ends = {word[:1].lower(), word[-1:].lower()}
    return {n for n in names if abs(len(n) - len(word)) < 3 and not ends.isdisjoint((n[:1].lower(), n[-1:].lower()))}


def mean(word: object, near: str) -> str:
    """Return the hint with the word that was probably meant; if the two look the same, the hint adds the difference."""
    said = difference(str(word), near)
    return f"did you mean `{near}`?" + (f" {said}" if said else "")


def did_you_mean(word: object, candidates: Iterable[str], what: str = "") -> str:
    """Return the hint for an unknown name: the nearest candidate, then up to eight after `what` ("motions/ has")."""
    names: Sequence[str] = sorted(set(candidates))
    near = nearest(word, names)
    shown = ", ".join(f"`{n}`" for n in names[:8]) + (", …" if len(names) > 8 else "")
    if near:
        return mean(word, near) + (f" {what} {shown}" if what and len(names) > 1 else "")
    if not names and what.endswith(":"):
        return "there are none yet: define one of this name, or delete the name here"
    if not names:
        return f"{what} {'none' if what.endswith('are') else 'nothing'}" if what else ""
    return f"{what or 'choose one of'} {shown}"
