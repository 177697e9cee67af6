"""The elements of an MJCF file and where they stand, as far as a file may go; MuJoCo itself is not imported here."""

from collections.abc import Mapping
from math import prod
from typing import NamedTuple
from xml.parsers import expat

MAX_ELEMENT_DEPTH = 100
"""Levels of elements within one another: MuJoCo and the parsers before it call themselves for each."""
MAX_ELEMENTS = 20_000
"""Elements of a file, and as how many one of them may be repeated."""

_BOUNDS: Mapping[str, tuple[tuple[tuple[str, ...], float], ...]] = {
    "replicate": ((("count",), MAX_ELEMENTS),),
    "composite": ((("count",), MAX_ELEMENTS),),
    "flexcomp": ((("count",), MAX_ELEMENTS),),
    "hfield": ((("nrow", "ncol"), 4_000_000),),
    "texture": ((("width", "height"), 64_000_000),),
    "option": tuple(((name,), 10_000) for name in ("iterations", "ls_iterations", "noslip_iterations")),
}
"""Of an element, attributes whose product is how much is made or done of it, and the most that this may be."""


class ModelElement(NamedTuple):
    """The beginning of an XML element, and where it stands; the outermost one has the depth 0."""

    name: str
    attributes: Mapping[str, str]
    line: int
    column: int
    depth: int = 0


class ModelFault(NamedTuple):
    """What keeps a model from being read, where, over how many characters, and what would be right."""

    line: int
    column: int
    length: int
    message: str
    hint: str


class _EnoughError(Exception):
    """The rest of the file is not looked at."""


def mjcf_elements(content: bytes) -> tuple[list[ModelElement], ModelFault | None]:
    """The elements of a model, and what is wrong with it as XML, or as more than a model may be."""
    reader = _Reader()
    try:
        reader.parser.Parse(content, True)
    except _EnoughError:
        return reader.elements, reader.fault
    except ValueError as error:  # an encoding of several bytes
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
    """Which attributes ask for more than may be, and how much; empty where none do."""
    for keys, most in _BOUNDS.get(name, ()):
        words = (word for key in keys for word in attributes.get(key, "").split())
        if (product := prod(abs(_number(word)) or 1.0 for word in words)) > most:
            return f"{' × '.join(f'`{key}`' for key in keys)} = {product:,.0f}, but at most {most:,.0f}"
    return ""


def _number(word: str) -> float:
    """The number that a word is; one where it is none, which MuJoCo tells."""
    try:
        return float(word)
    except ValueError:
        return 1.0
