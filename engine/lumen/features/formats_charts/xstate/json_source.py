"""Reads JSON files, with the place of each value."""

import json
from dataclasses import dataclass
from typing import Any

from lumen.language.diagnostics import NodePath, Place
from lumen.project.document import Document
from lumen.project.formats.conversion_findings import broken, check_size
from lumen.project.formats.foreign_json import foreign_json
from lumen.project.yaml_nodes import DUPLICATE_KEY
from lumen.project.yaml_reader import parse

MAX_JSON_LEVELS = 95
"""The maximum depth of nested objects and lists."""


@dataclass(frozen=True)
class JsonSource:
    """A file's data, and the place of each value."""

    data: Any
    document: Document
    repeated: tuple[tuple[Place, str], ...]
    """The places of keys that an object repeats, with messages; only the last value is used."""

    def place(self, path: NodePath) -> Place:
        """Return the place of a key or item, or of the nearest enclosing one that is known."""
        return self.document.place(path, key=True)


def parse_json(file: str, content: bytes) -> JsonSource:
    """Parse a file. Raises ForeignFileError if it is not JSON, too large, or nested too deeply."""
    check_size(file, content)
    try:
        data = foreign_json(content)
    except UnicodeDecodeError:
        raise broken(Place(file), "not-json", "the file's encoding is unknown", "save it as UTF-8") from None
    except json.JSONDecodeError as error:
        place = Place(file, error.lineno, error.colno, error.lineno, error.colno + 1)
        raise broken(place, "not-json", f"this is not JSON: {error.msg.lower()}") from None
    except ValueError as error:
        raise broken(Place(file), "not-json", f"this is not JSON: {error}") from None
    except RecursionError:
        raise broken(Place(file), "too-large", "the file is nested too deeply") from None
    if _depth(data) > MAX_JSON_LEVELS:
        raise broken(Place(file), "too-large", f"the file is nested deeper than {MAX_JSON_LEVELS} levels")
    document, found = parse(file, content.replace(b"\t", b" "))  # JSON is YAML, except for tabs and surrogates
    repeated = tuple((d.place, d.message) for d in found if d.code == DUPLICATE_KEY)
    if document is None or (document.data != data and not repeated):
        document = Document(file, data)  # places are unknown
    return JsonSource(data, document, repeated)


def _depth(data: Any) -> int:
    level, values = 0, [data]
    while values:
        level += 1
        values = [
            child
            for value in values
            for child in (value.values() if isinstance(value, dict) else value if isinstance(value, list) else ())
        ]
    return level
