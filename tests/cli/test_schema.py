"""The published schemas support completion and help in an editor: every property has a description and an example."""

import json
import os
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, strategies
from jsonschema import Draft202012Validator

from lumen.cli.jsonc import added, plain
from lumen.cli.main import main
from lumen.cli.schema import files, settings
from lumen.project.project_folders import file_kinds
from lumen.project.schema import load_schema
from tests import ROOT
from tests.tables import for_each

SAMPLES = {"examples", "enum", "const", "default", "properties"}


def properties(schema: Any, path: tuple[str, ...] = ()) -> Iterator[tuple[str, Any]]:
    """Yield each property of a schema and of the schemas within it, with its path."""
    if not isinstance(schema, dict):
        return
    for name, inner in schema.get("properties", {}).items():
        yield "/".join((*path, name)), inner
    for keyword in ("properties", "patternProperties", "$defs"):
        for name, inner in schema.get(keyword, {}).items():
            yield from properties(inner, (*path, name))
    for keyword in ("items", "additionalProperties", "then", "else", "if"):
        yield from properties(schema.get(keyword), path)
    for keyword in ("allOf", "anyOf", "oneOf", "prefixItems"):
        for inner in schema.get(keyword, ()):
            yield from properties(inner, path)


def whole(schema: Any, root: Any) -> dict[str, Any]:
    """Return a schema merged with the definitions that it refers to; its own keywords win."""
    found = dict(schema)
    while reference := schema.get("$ref"):
        schema = root["$defs"][reference.rpartition("/")[2]]
        found = {**schema, **found}
    return found


@for_each("kind", file_kinds())
def test_every_property_is_described_and_shown(kind: str) -> None:
    root = load_schema(kind)
    Draft202012Validator.check_schema(root)
    assert {"$schema", "$id", "title", "description"} <= root.keys()
    named = list(properties(root))
    assert named
    for name, schema in named:
        known = whole(schema, root)
        assert known.get("description"), name
        assert SAMPLES & known.keys() or known.get("type") == "boolean" or "$ref" in str(schema), name


@for_each("kind", file_kinds())
def test_examples_and_defaults_fit(kind: str) -> None:
    root = load_schema(kind)
    for name, schema in properties(root):
        validator = Draft202012Validator({**schema, "$defs": root.get("$defs", {})})
        for value in [*schema.get("examples", ()), *([schema["default"]] if "default" in schema else ())]:
            assert validator.is_valid(value), (name, value, next(validator.iter_errors(value)).message)


def test_a_schema_is_printed(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["schema", "motion"]) == 0
    assert json.loads(capsys.readouterr().out) == load_schema("motion")
    assert main(["schema"]) == 0
    assert [line.split()[0] for line in capsys.readouterr().out.splitlines()] == list(file_kinds())


def test_every_kind_has_its_files() -> None:
    assert files().keys() == set(file_kinds())
    shown = {kind for kind, (one, *_) in files().items() if {*ROOT.glob(one), *ROOT.glob(f"examples/*/{one}")}}
    assert files().keys() == shown


def test_settings_join_those_that_are_there(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    file = tmp_path / ".vscode" / "settings.json"
    assert main(["schema", "--vscode", "-o", str(file)]) == 0
    first = json.loads(file.read_text())
    assert first["yaml.schemas"]["./schemas/story.schema.json"] == ["behaviors/stories/*.yaml"]
    file.write_text(
        json.dumps({"editor.tabSize": 2, "yaml.schemas": {"x.json": ["*.x"]}, "json.schemas": [{"url": "y"}]})
    )
    assert main(["schema", "--vscode", "-o", str(file)]) == 0
    again = json.loads(file.read_text())
    assert again["editor.tabSize"] == 2
    assert again["yaml.schemas"] == {"x.json": ["*.x"], **first["yaml.schemas"]}
    assert again["json.schemas"] == [{"url": "y"}, *first["json.schemas"]]


MINE = """{
  // how wide a tab is
  "editor.tabSize": 2, /* not "4", */
  "files.associations": {"*.yaml": "yaml",},
  "yaml.schemas": {
    // of somebody else
    "x.json": ["*.x"], // http://x
  },
  "json.schemas": []
  // the end
}
"""


def test_comments_in_settings_stay(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Trailing commas stay, too, and a second run changes nothing."""
    monkeypatch.chdir(ROOT)
    file = tmp_path / "settings.json"
    file.write_text(MINE)
    assert main(["schema", "--vscode", "-o", str(file)]) == 0
    text = file.read_text()
    assert [line for line in MINE.splitlines() if line.strip() not in ('"json.schemas": []', "}", "},")] == [
        line for line in text.splitlines() if line in MINE.splitlines() and line.strip() not in ("}", "},")
    ]
    data, ours = json.loads(plain(text)), settings(ROOT)
    assert data["yaml.schemas"] == {"x.json": ["*.x"], **ours["yaml.schemas"]}
    assert data["json.schemas"] == ours["json.schemas"]
    assert data["editor.tabSize"] == 2
    assert main(["schema", "--vscode", "-o", str(file)]) == 0
    assert file.read_text() == text


@given(
    strategies.dictionaries(
        strategies.text('ab,/*"{', max_size=3),
        strategies.integers() | strategies.lists(strategies.text("/,*]", max_size=2), max_size=2),
        max_size=3,
    ),
    strategies.dictionaries(
        strategies.text('ab,/*"{', max_size=3), strategies.integers() | strategies.just({"x": 1}), max_size=3
    ),
    strategies.sampled_from(["", "// a, {\n", '/* "b" */']),
    strategies.sampled_from([None, 2]),
)
def test_what_is_added_to_settings_is_in_them(
    there: dict[str, Any], more: dict[str, Any], comment: str, indent: int | None
) -> None:
    text = comment + json.dumps(there, indent=indent)[:-1] + comment + "}" + comment
    assert json.loads(plain(added(text, more))) == {**there, **more}
    assert not comment or added(text, more).count(comment) == 3


def test_a_project_without_schemas_uses_those_of_lumen(tmp_path: Path) -> None:
    schemas = settings(tmp_path)["yaml.schemas"]
    assert schemas
    for schema in schemas:
        assert schema.startswith("file://")


@pytest.mark.parametrize("text", ["{,}", "[1]", "{ // mine", "/* {}"])
def test_settings_that_can_not_be_read_stay(text: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "settings.json"
    file.write_text(text)
    assert main(["schema", "--vscode", "-o", str(file)]) == 2
    assert file.read_text() == text
    assert "can't add to" in capsys.readouterr().err
    assert main(["schema", "--vscode", "motion"]) == 2


def test_settings_that_are_a_pipe_are_not_waited_for(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / ".vscode").mkdir()
    os.mkfifo(tmp_path / ".vscode" / "settings.json")
    assert main(["schema", "--vscode", "-o", str(tmp_path / ".vscode" / "settings.json")]) == 2
    assert "it is a device or a pipe" in capsys.readouterr().err
