"""The reference of the schemas: each has a page, each of its words its description."""

import json
import re

from scripts.schema_pages import page, pages

from tests import ROOT
from tests.scanning import matching
from tests.tables import for_each


def test_the_reference_has_a_page_for_each_schema() -> None:
    made = pages(ROOT / "schemas")
    assert set(made) >= {"motion.md", "lumen.md", "messages/command.md", "README.md", "messages/README.md"}
    assert len(made) == len(matching(ROOT / "schemas", "**/*.schema.json")) + 2


@for_each(
    "kind", ["behavior", "lumen", "motion", "story", "controller", "body", "words", "knowledge", "life", "gestures"]
)
def test_the_reference_names_describes_and_shows_each_property(kind: str) -> None:
    schema = json.loads((ROOT / f"schemas/{kind}.schema.json").read_text(encoding="utf-8"))
    text = page(schema, kind)
    for key, part in schema["properties"].items():
        assert re.search(rf"(?m)^## {re.escape(key)}$", text), key
        assert part.get("description", "") in text, key
        assert not part.get("examples") or "```yaml" in text.partition(f"\n## {key}\n")[2].partition("\n## ")[0], key


def test_limits_defaults_and_references_are_told() -> None:
    part = {"type": "array", "items": {"$ref": "#/$defs/speed"}, "minItems": 1, "default": [], "examples": [[1, 2]]}
    schema = {"title": "T", "required": ["a"], "properties": {"a": part}, "$defs": {"speed": {"type": "number"}}}
    assert page(schema, "`t`") == (
        "# T\n\nSchema: `t`.\n\n## a\n\n"
        "*list of [speed](#def-speed)* · at least 1 entries · without it `[]` · **required**"
        "\n\n```yaml\n[1, 2]\n```\n\n## speed (shared) {#def-speed}\n\n*number*\n"
    )
