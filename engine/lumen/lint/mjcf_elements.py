"""The elements of an MJCF file and their positions, within size limits; MuJoCo itself is not imported here."""

from collections.abc import Mapping
from math import prod
from typing import NamedTuple
from xml.parsers import expat

MAX_ELEMENT_DEPTH = 100
"""The maximum number of nested levels: MuJoCo's parser recurses at each level."""
MAX_ELEMENTS = 20_000
"""The maximum number of elements of a file, and of repetitions of an element."""

_BOUNDS: Mapping[str, tuple[tuple[tuple[str, ...], float], ...]] = {
    "replicate": ((("count",), MAX_ELEMENTS),),
    "composite": ((("count",), MAX_ELEMENTS),),
    "flexcomp": ((("count",), MAX_ELEMENTS),),
    "hfield": ((("nrow", "ncol"), 4_000_000),),
    "texture": ((("width", "height"), 64_000_000),),
    "option": tuple(((name,), 10_000) for name in ("iterations", "ls_iterations", "noslip_iterations")),
}
"""For each element, attributes whose product is the amount of work or memory, and its limit."""


class ModelElement(NamedTuple):
    """The start tag of an XML element, with its place."""

    name: str
    """The name of the tag."""
    attributes: Mapping[str, str]
    """The attributes of the element."""
    line: int
    """The line of the tag, from 1."""
    column: int
    """The column of the tag, from 1."""
    depth: int = 0
    """The number of elements around the element; 0 for the outermost element."""


class ModelFault(NamedTuple):
    """A reason why a model can't be read."""

    line: int
    """The line of the fault, from 1."""
    column: int
    """The column of the fault, from 1."""
    length: int
    """The number of characters to mark."""
    message: str
    """The fault, in words."""
    hint: str
    """The remedy, in words."""


class _EnoughError(Exception):
    """Raised to stop reading the rest of the file."""


def mjcf_elements(content: bytes) -> tuple[list[ModelElement], ModelFault | None]:
    """Return the elements of a model, and its first fault (invalid XML, an entity, an exceeded limit) or None.

    If the XML is invalid, there are no elements; at any other fault, reading stops, and the elements up to it remain.
    """
    reader = _Reader()
    try:
        reader.parser.Parse(content, True)
    except _EnoughError:
        return reader.elements, reader.fault
    except ValueError as error:  # a multi-byte encoding, which expat can't read
        return [], ModelFault(1, 1, 1, f"this is not valid XML: {error}", "save it as UTF-8")
    except expat.ExpatError as error:
        reason = expat.ErrorString(error.code)
        hint = "look for a tag or a quote that is not closed, here or above"
        return [], ModelFault(error.lineno, error.offset + 1, 1, f"this is not valid XML: {reason}", hint)
    return reader.elements, None


class _Reader:
    def __init__(self) -> None:
        self.elements: list[ModelElement] = []
        self.fault: ModelFault | None = None
        self.parser = expat.ParserCreate()
        self.parser.StartElementHandler = self._begin
        self.parser.EndElementHandler = self._end
        self.parser.EntityDeclHandler = self._entity
        self._depth = 0

    def _begin(self, name: str, attributes: Mapping[str, str]) -> None:
        here = self.parser.CurrentLineNumber, self.parser.CurrentColumnNumber + 1
        self.elements.append(ModelElement(name, attributes, *here, self._depth))
        self._depth += 1
        if self._depth > MAX_ELEMENT_DEPTH:
            self._stop(len(name) + 1, f"the model is nested deeper than {MAX_ELEMENT_DEPTH} levels", "use fewer levels")
        if len(self.elements) > MAX_ELEMENTS:
            self._stop(len(name) + 1, f"the model has more than {MAX_ELEMENTS:,} elements", "use fewer")
        if reason := _too_many(name, attributes):
            self._stop(len(name) + 1, f"`<{name}>` has {reason} can be simulated", "use fewer")

    def _end(self, name: str) -> None:
        self._depth -= 1

    def _entity(self, name: str, *_: object) -> None:
        self._stop(2, f"a model can't use the entity {name[:40]}", "write the text of the entity instead")

    def _stop(self, length: int, message: str, hint: str) -> None:
        line, column = self.parser.CurrentLineNumber, self.parser.CurrentColumnNumber + 1
        self.fault = ModelFault(line, column, length, message, hint)
        raise _EnoughError


def _too_many(name: str, attributes: Mapping[str, str]) -> str:
    """Return in words the attributes whose product exceeds the element's limit; empty if there are none."""
    for keys, most in _BOUNDS.get(name, ()):
        words = (word for key in keys for word in attributes.get(key, "").split())
        if (product := prod(abs(_number(word)) or 1.0 for word in words)) > most:
            return f"{' × '.join(f'`{key}`' for key in keys)} = {product:,.0f}, but at most {most:,.0f}"
    return ""


def _number(word: str) -> float:
    """Return the number in a word; 1.0 for any other word, because MuJoCo reports such words."""
    try:
        return float(word)
    except ValueError:
        return 1.0
