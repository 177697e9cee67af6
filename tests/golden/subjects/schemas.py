"""The output of `lumen schema` for each kind of file, and the schemas of messages; their words in `words/`.

A description is improved more often than a schema, so it is left out of `schemas/` and held by its path.
"""

import json
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from tests.golden.command_line import CHECKOUT, lumen, workplace
from tests.golden.found import write_json
from tests.golden.golden import PROJECTS

SUITE = "test"
WORDS = ("title", "description")


def record(folder: Path) -> None:
    """Write each schema without its words, and its words."""
    for part in ("schemas", "words"):
        (folder / part).mkdir()
    with workplace() as work:
        kinds = [row["kind"] for row in json.loads(lumen(work, "schema", "--format", "json").out)["kinds"]]
        for kind in kinds:
            _write(folder, kind, json.loads(lumen(work, "schema", kind).out))
    messages = sorted((CHECKOUT / "schemas/messages").glob("*.schema.json"))
    messages += sorted(PROJECTS.glob("museum/schemas/messages/*.schema.json"))
    assert len(kinds) > 10
    assert len(messages) > 20
    for file in messages:
        _write(folder, f"message.{file.name.removesuffix('.schema.json')}", json.loads(file.read_text("utf-8")))


def _write(folder: Path, name: str, schema: Any) -> None:
    write_json(folder / "schemas" / f"{name}.json", _bare(schema))
    write_json(folder / "words" / f"{name}.json", dict(_words(schema, "")))


def _bare(schema: Any) -> Any:
    """Return a schema without its words; `properties` may have such names."""
    if isinstance(schema, list):
        return [_bare(one) for one in schema]
    if not isinstance(schema, dict):
        return schema
    return {key: _bare(value) for key, value in schema.items() if not (key in WORDS and isinstance(value, str))}


def _words(schema: Any, path: str) -> Iterator[tuple[str, str]]:
    if isinstance(schema, dict | list):
        for key, value in schema.items() if isinstance(schema, dict) else enumerate(schema):
            if key in WORDS and isinstance(value, str):
                yield f"{path}/{key}", value
            else:
                yield from _words(value, f"{path}/{key}")
