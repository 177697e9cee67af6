"""A YAML file as text that can be cut and joined at its nodes: a mutant keeps the rest as its author wrote it."""

from lumen.language.diagnostics import NodePath, Place
from lumen.project.document import Document
from lumen.project.yaml_reader import parse


class Sheet:
    """A file with the places of its nodes; its methods return the text of a mutant."""

    def __init__(self, file: str, content: bytes) -> None:
        document, found = parse(file, content)
        assert document, found
        self.document: Document = document
        self.text = document.text
        self._starts = [0]
        for line in self.text.splitlines(keepends=True):
            self._starts.append(self._starts[-1] + len(line))
        self.keys = [path for path, span in document.spans.items() if span.key]
        self.leaves = [path for path in document.spans if path and not isinstance(self.value(path), dict | list)]
        self.nodes = [path for path in document.spans if path]

    def value(self, path: NodePath) -> object:
        """Return the plain data at a path."""
        node = self.document.data
        for step in path:
            node = node[step]
        return node

    def offsets(self, place: Place) -> tuple[int, int]:
        """Return the start and end of a place in the text, without the blanks behind a block."""
        start = self._starts[place.line - 1] + place.column - 1
        end = self._starts[min(place.end_line, len(self._starts)) - 1] + place.end_column - 1
        return start, start + len(self.text[start:end].rstrip())

    def source(self, path: NodePath, *, key: bool = False) -> str:
        """Return the text of a value or of its key."""
        start, end = self.offsets(self.document.place(path, key=key))
        return self.text[start:end]

    def replaced(self, path: NodePath, new: str, *, key: bool = False) -> str:
        """Return the text with another value or key at a path."""
        start, end = self.offsets(self.document.place(path, key=key))
        return self.text[:start] + new + self.text[end:]

    def entry(self, path: NodePath) -> tuple[int, int]:
        """Return the offsets of the start of a key and of the end of its value."""
        span = self.document.spans[path]
        return self.offsets(span.key or span.value)[0], self.offsets(span.value)[1]

    def without(self, path: NodePath) -> str:
        """Return the text without a key and its value; if they fill whole lines, those lines are removed."""
        start, end = self.entry(path)
        line = self.text.rfind("\n", 0, start) + 1
        if self.text[line:start].strip() == "" and self.text[end : end + 1] in ("\n", ""):
            return self.text[:line] + self.text[end + 1 :]
        after = end + len(self.text[end:]) - len(self.text[end:].lstrip(", "))
        return self.text[:start] + self.text[after:]
