"""Collect the findings about one document, addressed by the paths of its nodes."""

import re
from collections.abc import Callable, Hashable, Iterable
from typing import Any, TypeVar

from lumen.language.diagnostics import Code, Diagnostic, NodePath, Related
from lumen.project.complaints import UNKNOWN_KEY
from lumen.project.document import Document
from lumen.project.memoization import memoize

T = TypeVar("T")

_QUOTED = re.compile(r"(?<=[`.#])[^`.#]+(?=[`.])")


class DocumentReport:
    """Collects the diagnostics of one document. Checks call it with the path of the faulty node."""

    def __init__(self, document: Document) -> None:
        self.document = document
        self.diagnostics: list[Diagnostic] = []
        self.pruned: set[NodePath] = set()
        """The paths of nodes that were taken out because they are broken.

        A misspelt key counts as pruned under the name that was probably meant.
        """
        self.lost: set[str] = {*document.dropped}
        """The names in pruned nodes. Findings that such a name is unknown (`unknown-…`) are left out."""
        self.missed: set[str] = set()
        """Names without a definition; a similar name may have been meant, and then only looks unused."""
        self.whole = True
        """True if everything in the file was built. If not, the broken part may hold what others lack."""

    def __call__(
        self,
        code: Code,
        path: NodePath,
        message: str,
        hint: str = "",
        *,
        key: bool = False,
        related: Iterable[tuple[NodePath, str]] = (),
        cause: str = "",
        root: str = "",
    ) -> None:
        """Report what is wrong with the node at `path`; `related` are nodes of the same document.

        A finding that only follows from a pruned node is left out. Findings of the same `cause` become one: see
        `gathered`.
        """
        if not self.follows(code, message):
            place = self.document.place(path, key=key)
            others = tuple(Related(self.document.place(where, key=True), what) for where, what in related)
            self.diagnostics.append(Diagnostic(code, message, place, hint, code.severity, others, cause, root))

    def copy(self) -> "DocumentReport":
        """Return an independent copy, to which more findings can be added."""
        other = DocumentReport(self.document)
        other.take(self)
        return other

    def take(self, other: "DocumentReport") -> None:
        """Replace all findings by those of another report."""
        self.document = other.document
        self.diagnostics = [*other.diagnostics]
        self.pruned, self.lost, self.missed = {*other.pruned}, {*other.lost}, {*other.missed}

    def memoize(self, slot: Hashable, given: Any, make: Callable[[], T]) -> T:
        """Return what `make` returns and add what it reports, both cached by text, findings and `given`."""
        before = (self.document.text, [*self.diagnostics], {*self.pruned}, {*self.lost}, {*self.missed})
        made, after = memoize(slot, (before, given), lambda: (make(), self.copy()))
        self.take(after)
        return made

    def broken(self, path: NodePath) -> bool:
        """Return True if the node at `path`, one above it or one within it was pruned."""
        return any(lost[: len(path)] == path[: len(lost)] for lost in self.pruned)

    def follows(self, code: str, message: str) -> bool:
        """Return True if a finding only follows from what was pruned: an unknown name that a pruned node defined."""
        named = code.startswith("unknown-") and code != UNKNOWN_KEY and self.lost
        return bool(named) and not self.lost.isdisjoint(_QUOTED.findall(message))
