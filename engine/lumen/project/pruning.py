"""Remove nodes from a report's document; the others keep their places."""

from collections.abc import Iterator
from typing import Any

from lumen.language.diagnostics import NodePath
from lumen.language.json_paths import values_in
from lumen.project.document import Document, NodeSpan
from lumen.project.document_report import DocumentReport


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
