"""Collect the findings about one document, addressed by the paths of its nodes, and remove nodes from it."""

import re
from collections.abc import Callable, Hashable, Iterable, Iterator
from typing import Any, TypeVar

from lumen.language.diagnostics import Code, Diagnostic, NodePath, Related
from lumen.language.json_paths import values_in
from lumen.project.complaints import UNKNOWN_KEY
from lumen.project.document import Document, NodeSpan
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
        """Names that are used but not defined. A defined name of similar spelling may be meant, so it is not unused."""
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
        """Return the result of `make` and add its findings; both are cached by text, earlier findings and `given`."""
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


def prune(report: DocumentReport, doomed: set[NodePath]) -> None:
    """Remove these nodes from the report's document, and record the names that were lost with them.

    Later items of a list move up, and their places with them.
    """
    document = report.document
    for path in doomed:
        report.lost.update(_names(document.value(path)))
        if path and isinstance(path[-1], str):
            report.lost.add(path[-1])
    copy = _Copy(document, doomed)
    data = copy.of(document.data, (), ())
    gone = {(*copy.moved.get(path[:-1], path[:-1]), path[-1]) for path in doomed}
    report.pruned = {copy.moved.get(path, path) for path in report.pruned} | gone
    report.document = Document(document.file, data, copy.spans, document.text)


class _Copy:
    """A copy of a document's data without the doomed nodes; `moved` maps old paths to new ones."""

    def __init__(self, document: Document, doomed: set[NodePath]) -> None:
        self._document, self._doomed = document, doomed
        self.spans: dict[NodePath, NodeSpan] = {}
        self.moved: dict[NodePath, NodePath] = {}

    def of(self, data: Any, old: NodePath, new: NodePath) -> Any:
        """Return the copy of the data at `old`, with its places under the path `new`."""
        self.moved[old] = new
        if old in self._document.spans:
            self.spans[new] = self._document.spans[old]
        if isinstance(data, dict):
            kept = [key for key in data if (*old, key) not in self._doomed]
            return {key: self.of(data[key], (*old, key), (*new, key)) for key in kept}
        if isinstance(data, list):
            left = [i for i in range(len(data)) if (*old, i) not in self._doomed]
            return [self.of(data[i], (*old, i), (*new, n)) for n, i in enumerate(left)]
        return data


def _names(data: Any) -> Iterator[str]:
    """Yield every name that `data` may define: its keys and its texts."""
    for item in values_in(data):
        if isinstance(item, str):
            yield item
        elif isinstance(item, dict):
            yield from item
