"""Convert composed YAML nodes to plain data, with the place of each."""

import re
from collections.abc import Iterator
from itertools import chain, pairwise
from typing import Any

import yaml

from lumen.language.diagnostics import ERROR, Code, Diagnostic, NodePath, Place, Related
from lumen.language.lookalikes import typed
from lumen.project.document import MAX_NODE_DEPTH, MAX_NODES, TOO_LARGE, Document, NodeSpan
from lumen.project.slips import BARE_BRACES, QUOTE_BRACES
from lumen.project.yaml_composer import PLAIN_TAGS, TooLargeError, compose
from lumen.project.yaml_scalars import resolve

COMPLEX_KEY = Code("complex-key", "text", ERROR, "a key is a list or a map")
DUPLICATE_KEY = Code("duplicate-key", "text", ERROR, "a key is written twice in the same place")
DECIMAL_COMMA = Code("decimal-comma", "text", ERROR, "a number is written with a comma")
YAML_TAG = Code("yaml-tag", "text", ERROR, "a value has a YAML tag")

_WHOLE, _DECIMALS = re.compile(r"[-+]?[0-9]+"), re.compile(r"[0-9]+(ms|s|min|h)?")
_SMALLER = "split the file, or use fewer levels and aliases"
_TAGS = {"!include": "copy the content of that file here: a file can't include another"}


def read_text(text: str) -> Document | None:
    """Return the document in a trial version of a text; None if it has any fault as YAML. Nothing is cached."""
    try:
        node = compose(text)
    except (yaml.YAMLError, TooLargeError):
        return None
    if node is None:
        return None
    reader = NodeReader("", text)
    data = reader.read(node, (), None, 0)
    return None if reader.diagnostics else Document("", data, reader.spans, text)


def too_large(file: str, error: TooLargeError) -> Diagnostic:
    """Return the finding about a file that is too large."""
    mark = error.mark
    place = Place(file, mark.line + 1, mark.column + 1, mark.line + 1, mark.column + 2) if mark else Place(file)
    return TOO_LARGE.at(place, f"the file is too large to be read: {error}", _SMALLER)


class NodeReader:
    """Converts composed nodes to plain data, and records the place of each."""

    def __init__(self, file: str, text: str) -> None:
        self.file, self.text = file, text
        self.spans: dict[NodePath, NodeSpan] = {}
        self.diagnostics: list[Diagnostic] = []
        self.full = False
        self.dropped: set[str] = set()

    def read(self, node: yaml.Node, path: NodePath, key: yaml.Node | None, depth: int) -> Any:
        self.spans[path] = _new(NodeSpan, (None if key is None else self.place(key), self.place(node)))
        if depth > MAX_NODE_DEPTH or len(self.spans) > MAX_NODES:
            self.overflow(node, depth)
            return None
        if node.tag not in PLAIN_TAGS:
            self.say(
                YAML_TAG,
                node,
                "a tag (a word that begins with `!`) has no meaning here",
                _TAGS.get(node.tag, "delete the tag"),
            )
        if isinstance(node, yaml.ScalarNode):
            return node.value if node.style else resolve(node.value)
        if isinstance(node, yaml.SequenceNode):
            if numbers := _decimals(node):
                return self.commas(node, numbers)
            return [self.read(child, (*path, i), None, depth + 1) for i, child in enumerate(node.value)]
        assert isinstance(node, yaml.MappingNode)
        if braces := self.braces(node):
            return braces
        return self.mapping(node, path, depth)

    def braces(self, node: yaml.MappingNode) -> str:
        """Return the text of `{{ … }}` without quotes, which YAML reads as a map in a map; empty for other maps."""
        if not (node.flow_style and len(node.value) == 1 and isinstance(node.value[0][0], yaml.MappingNode)):
            return ""
        start, end = node.start_mark, node.end_mark
        text = self.text[start.index : end.index]
        if not (text.startswith("{{") and text.endswith("}}")):
            return ""
        place = self.place(node)._replace(end_line=start.line + 1, end_column=start.column + 3)
        self.diagnostics.append(COMPLEX_KEY.at(place, BARE_BRACES, QUOTE_BRACES))
        return text

    def commas(self, node: yaml.SequenceNode, numbers: list[str]) -> list[Any]:
        """Report a list of numbers that are written with commas; return the numbers."""
        message = "a comma separates numbers, so this list would have twice as many"
        self.say(DECIMAL_COMMA, node, message, f"write points: [{', '.join(numbers)}]")
        return [resolve(number) for number in numbers]

    def mapping(self, node: yaml.Node, path: NodePath, depth: int) -> dict[str, Any]:
        data: dict[str, Any] = {}
        last: yaml.Node | None = None
        begun = _begun_anew(node)
        for key, value in node.value:
            before, last = last, value
            if before is not None and data and (number := _decimal(before, key, value)):
                self.comma(before, key, number)
                data[next(reversed(data))] = resolve(number)
            elif begun is not None and key is begun[0]:
                self.too_deep(key, begun[1], depth)
                self.dropped.update(_texts_below(node))
                break
            elif not isinstance(key, yaml.ScalarNode):
                hint = "put quotes around a text that begins with `{`"
                self.say(COMPLEX_KEY, key, "a key must be a single word or text", hint)
            elif key.value in data:
                self.duplicate(key, path)
                if data[key.value] is None:  # the line is doubled, and the second one has the content
                    data[key.value] = self.read(value, (*path, key.value), key, depth + 1)
                else:
                    self.dropped.update(_texts_below(value))
            else:
                data[key.value] = self.read(value, (*path, key.value), key, depth + 1)
        return data

    def comma(self, before: yaml.Node, key: yaml.Node, number: str) -> None:
        """Report a number that is written with a comma."""
        start, end = before.start_mark, key.end_mark
        place = Place(self.file, start.line + 1, start.column + 1, end.line + 1, end.column + 1)
        message = f"a comma ends the number {before.value}, so `{key.value}` would be a key"
        self.diagnostics.append(DECIMAL_COMMA.at(place, message, f"write a point: {number}"))

    def duplicate(self, key: yaml.Node, path: NodePath) -> None:
        """Report a duplicate key; all duplicate keys of one map have one cause, so they become one finding."""
        first = self.spans[(*path, key.value)].key
        hint = f"delete one of them: the first one is on line {first.line}" if first else ""
        related = (Related(first, "the first one is here"),) if first else ()
        message, cause = f"`{key.value}` is written twice in the same place", f"{self.file} twice in {path}"
        self.diagnostics.append(DUPLICATE_KEY.at(self.place(key), message, hint, related=related, cause=cause))

    def too_deep(self, key: yaml.Node, first: yaml.Node, depth: int) -> None:
        """Report a key in the same column as the keys that belong below it; `first` is the first of those."""
        message = f"`{key.value}` is in the same column as `{first.value}` below it, so some keys are written twice"
        blanks = "2 spaces" if key.start_mark.column > 1 else "the spaces"
        self.say(DUPLICATE_KEY, key, message, f"delete {blanks} before `{key.value}`")

    def overflow(self, node: yaml.Node, depth: int) -> None:
        if not self.full:
            self.full = True
            what = (
                f"nested deeper than {MAX_NODE_DEPTH} levels"
                if depth > MAX_NODE_DEPTH
                else f"more than {MAX_NODES:,} values"
            )
            self.diagnostics.append(too_large(self.file, TooLargeError(what, node.start_mark)))

    def say(self, code: Code, node: yaml.Node, message: str, hint: str) -> None:
        self.diagnostics.append(code.at(self.place(node), message, hint))

    def place(self, node: yaml.Node) -> Place:
        start, end = node.start_mark, node.end_mark
        return _new(Place, (self.file, start.line + 1, start.column + 1, end.line + 1, end.column + 1))


_new = tuple.__new__
"""A constructor of named tuples that needs half the time of a call: each node of each file has a place."""


def _decimal(before: yaml.Node, key: yaml.Node, value: yaml.Node) -> str:
    """Return the number in `x: 1,5`, which YAML reads as the value `1` and an empty key `5`; empty for other text."""
    if key.start_mark.index != before.end_mark.index + 1 or value.start_mark.index != value.end_mark.index:
        return ""
    plain = all(isinstance(node, yaml.ScalarNode) and not node.style for node in (before, key, value))
    whole, decimals = typed(before.value if plain else ""), typed(key.value if plain else "")
    return f"{whole}.{decimals}" if _WHOLE.fullmatch(whole) and _DECIMALS.fullmatch(decimals) else ""


def _begun_anew(node: yaml.Node) -> tuple[yaml.Node, yaml.Node] | None:
    """Return an empty key after which two or more keys of a map repeat, and the first of those; else None."""
    empty = [isinstance(value, yaml.ScalarNode) and not value.style and not value.value for _, value in node.value]
    if True not in empty:
        return None
    keys = [key.value if isinstance(key, yaml.ScalarNode) else "" for key, _ in node.value]
    before: set[str] = set()
    for i, (key, _) in enumerate(node.value[:-1]):
        if empty[i] and keys[i + 1] in before and keys[i] not in before:
            again = [name for name in keys[i + 1 :] if name and name in before]
            if len(again) > 1:
                return key, node.value[i + 1][0]
        before.add(keys[i])
    return None


def _decimals(node: yaml.SequenceNode) -> list[str]:
    """Return the numbers of a list such as `[1,5, 2,5]`, written with decimal commas; empty for any other list."""
    items = node.value
    if len(items) < 4 or len(items) % 2 or not node.flow_style:
        return []
    if not all(isinstance(item, yaml.ScalarNode) and not item.style for item in items):
        return []
    near = [a.end_mark.index + 1 == b.start_mark.index for a, b in pairwise(items)]
    if near != [i % 2 == 0 for i in range(len(near))]:
        return []
    pairs = [(items[i].value, items[i + 1].value) for i in range(0, len(items), 2)]
    sound = all(_WHOLE.fullmatch(whole) and _DECIMALS.fullmatch(part) for whole, part in pairs)
    return [f"{whole}.{part}" for whole, part in pairs] if sound else []


def _texts_below(node: yaml.Node) -> Iterator[str]:
    """Yield every key and text below a node, each part of the file once."""
    waiting, seen = [node], set[int]()
    while waiting:
        item = waiting.pop()
        if isinstance(item, yaml.ScalarNode):
            yield item.value
        elif id(item) not in seen:
            seen.add(id(item))
            waiting += chain.from_iterable(item.value) if isinstance(item, yaml.MappingNode) else item.value
