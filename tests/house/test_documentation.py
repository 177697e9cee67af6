"""The documentation: each page is listed, each link leads somewhere, each word of a schema has its description."""

import json
import re
from pathlib import Path

import pytest
from scripts.schema_pages import page, pages

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
INDEX = (DOCS / "README.md").read_text(encoding="utf-8")
DECISIONS = (DOCS / "decisions/README.md").read_text(encoding="utf-8")
PAGES = [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *sorted(DOCS.rglob("*.md"))]

BLOCK = re.compile(r"(?m)^(?:```|````)[\s\S]*?^(?:```|````)$")
LINK = re.compile(r"\]\(([^)\s]+)\)")
HEADING = re.compile(r"(?m)^#+ (.+)$")


def anchors(page: Path) -> set[str]:
    """The anchors of a page's headings, as GitHub and the site make them."""
    text = BLOCK.sub("", page.read_text(encoding="utf-8"))
    plain = (re.sub(r"[`*]|\[([^\]]*)\]\([^)]*\)", r"\1", heading) for heading in HEADING.findall(text))
    return {re.sub(r"[^\w\- ]", "", heading.strip().lower()).replace(" ", "-") for heading in plain}


def test_the_index_lists_every_page() -> None:
    listed = set(re.findall(r"(?m)^- \[[^\]]+\]\(([\w./-]+)\)", INDEX))
    there = {file.relative_to(DOCS).as_posix() for file in DOCS.glob("*.md")} - {"README.md"}
    there |= {file.relative_to(DOCS).as_posix() for file in DOCS.glob("*/README.md")}
    assert there - listed == set()


def test_the_list_of_decisions_is_complete_and_calls_each_by_its_title() -> None:
    files = sorted((DOCS / "decisions").glob("[0-9]*.md"))
    titles = [re.sub(r"^# (\d+):? ", r"\1 ", file.read_text(encoding="utf-8").partition("\n")[0]) for file in files]
    rows = re.findall(r"(?m)^- \[(\d+)\]\(([^)]+)\) (.+)$", DECISIONS)
    assert [(file.name, title) for file, title in zip(files, titles, strict=True)] == [
        (link, f"{number} {title}") for number, link, title in rows
    ]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(ROOT)))
def test_links_lead_to_files_and_headings_that_are_there(page: Path) -> None:
    lost = []
    for link in LINK.findall(BLOCK.sub("", page.read_text(encoding="utf-8"))):
        if re.match(r"[a-z]+:", link):
            continue
        file, _, anchor = link.partition("#")
        target = page.parent / file if file else page
        if not target.exists() or (anchor and target.suffix == ".md" and anchor not in anchors(target)):
            lost.append(link)
    assert lost == []


def test_the_page_about_the_environment_names_every_variable_that_is_read() -> None:
    page = (DOCS / "environment.md").read_text(encoding="utf-8")
    code = "".join(file.read_text(encoding="utf-8") for file in (ROOT / "engine/lumen").rglob("*.py"))
    read = set(re.findall(r'"(LUMEN_[A-Z_]+)"', code)) | set(re.findall(r'environ(?:\.get\(|\[)"(\w+)"', code))
    assert {name for name in read if f"`{name}`" not in page} <= {"GITHUB_WORKSPACE", "LOCALAPPDATA", "TERM"}


def test_the_reference_has_a_page_for_each_schema() -> None:
    made = pages(ROOT / "schemas")
    assert set(made) >= {"motion.md", "lumen.md", "messages/command.md", "README.md", "messages/README.md"}
    assert len(made) == len(list((ROOT / "schemas").rglob("*.schema.json"))) + 2


@pytest.mark.parametrize(
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
