"""Write schemas/*.json from their sources: `python scripts/schemas.py`; `make check` compares them.

The schema of a file in which features have sections is `engine/lumen/project/NAME.schema.json`. If the value of a key
is the folder of a feature, as in `"alerts": "features/alerts"`, the key's schema is in `schema.json` there, under the
same key. A schema that belongs to one feature alone, as fleet.schema.json, is in its folder. All other schemas are
their own sources.
"""

import re
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "engine/lumen"
SCHEMAS = ROOT / "schemas"
WRITTEN_BY_A_FEATURE = re.compile(r'^( *)"([^"]+)": "(features/\w+)"(,?)$')


def composed() -> Iterator[tuple[Path, str]]:
    """Yield the path and the text of each schema that has sources. Raises KeyError for a key without any."""
    for source in sorted(PACKAGE.glob("project/*.schema.json")):
        lines = [_expanded(line) for line in source.read_text(encoding="utf-8").splitlines()]
        yield SCHEMAS / source.name, "\n".join(lines) + "\n"
    for source in sorted(PACKAGE.glob("features/*/*.schema.json")):
        yield SCHEMAS / source.name, source.read_text(encoding="utf-8")


def _expanded(line: str) -> str:
    """Return a line, or the schema in the folder of a feature that replaces it."""
    if (match := WRITTEN_BY_A_FEATURE.match(line)) is None:
        return line
    indent, key, folder, comma = match.groups()
    block = fragments(PACKAGE / folder / "schema.json")[key]
    return "\n".join(f"{indent}{row[2:]}" for row in block) + comma


def fragments(file: Path) -> dict[str, list[str]]:
    """Return the lines of each key of a file `schema.json`, whose keys are indented by two spaces."""
    found: dict[str, list[str]] = {}
    for line in file.read_text(encoding="utf-8").splitlines()[1:-1]:
        if match := re.match(r'  "([^"]+)":', line):
            found[match[1]] = []
        found[[*found][-1]].append(line)
    return {key: [*lines[:-1], lines[-1].removesuffix(",")] for key, lines in found.items()}


if __name__ == "__main__":
    for path, text in composed():
        path.write_text(text, encoding="utf-8")
