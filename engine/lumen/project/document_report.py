"""What is wrong with one document, said by the paths of its nodes."""

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
    """Collects the diagnostics of one document; whoever finds something calls it with the path of the node.

    `pruned` are the paths of nodes that were taken out because they are broken, and `lost` the names that stood in
    them: that such a name is unknown (`unknown-…`) follows from what has been said, and is not said. A key that was
    misspelt counts as pruned under the name that was meant. `missed` are names that stand for nothing: something of
    a like name may have been meant, and looks unused. `whole` is whether everything that the file says was built:
    what is absent in another was perhaps meant by what is broken.
    """

    def __init__(self, document: Document) -> None:
        self.document = document
        self.diagnostics: list[Diagnostic] = []
        self.pruned: set[NodePath] = set()
        self.lost: set[str] = {*document.dropped}
        self.missed: set[str] = set()
        self.whole = True

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

        Findings of the same `cause` become one: see `gathered`.
        """
        if not self.follows(code, message):
            place = self.document.place(path, key=key)
            others = tuple(Related(self.document.place(where, key=True), what) for where, what in related)
            self.diagnostics.append(Diagnostic(code, message, place, hint, code.severity, others, cause, root))

    def copy(self) -> "DocumentReport":
        """Another report that says the same, and to which more can be said."""
        other = DocumentReport(self.document)
        other.take(self)
        return other

    def take(self, other: "DocumentReport") -> None:
        """Say what the other says, and nothing else."""
        self.document = other.document
        self.diagnostics = [*other.diagnostics]
        self.pruned, self.lost, self.missed = {*other.pruned}, {*other.lost}, {*other.missed}

    def memoize(self, slot: Hashable, given: Any, make: Callable[[], T]) -> T:
        """What `make` made and said here when last given the same of the same file, else what it makes and says now."""
        before = (self.document.text, [*self.diagnostics], {*self.pruned}, {*self.lost}, {*self.missed})
        made, after = memoize(slot, (before, given), lambda: (make(), self.copy()))
        self.take(after)
        return made

    def broken(self, path: NodePath) -> bool:
        """Whether the node at `path`, one above it or one in it, was pruned."""
        return any(lost[: len(path)] == path[: len(lost)] for lost in self.pruned)

    def follows(self, code: str, message: str) -> bool:
        """Whether a finding only follows from what was pruned: a name is unknown that stood there."""
        named = code.startswith("unknown-") and code != UNKNOWN_KEY and self.lost
        return bool(named) and not self.lost.isdisjoint(_QUOTED.findall(message))
