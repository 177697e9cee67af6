"""The schemas themselves, and what is left of a document after its broken nodes are taken out."""

import json
from collections.abc import Iterator
from typing import Any

import jsonschema
import pytest

from lumen.expressions.expression_findings import UNKNOWN_STATE
from lumen.project import misindented, schema
from lumen.project.complaints import Complaint
from lumen.project.document import Document
from lumen.project.document_report import DocumentReport
from lumen.project.packaged import schema_folder
from lumen.project.project_folders import file_kinds
from lumen.project.schema import check_schema, faults, load_schema
from lumen.project.yaml_nodes import read_text
from lumen.project.yaml_reader import parse
from tests.scanning import matching
from tests.tables import for_each


def check(text: str, kind: str = "behavior") -> tuple[Any, DocumentReport]:
    document, diagnostics = parse("x.yaml", text.encode())
    assert document
    assert not diagnostics
    report = DocumentReport(document)
    return check_schema(document, kind, report), report


@for_each("kind", file_kinds())
def test_a_schema_is_strict_and_describes_its_keys(kind: str) -> None:
    schema = load_schema(kind)
    jsonschema.Draft202012Validator.check_schema(schema)
    assert schema["$id"]
    waiting = [schema]
    while waiting:
        node = waiting.pop()
        if isinstance(node, dict):
            node = {key: child for key, child in node.items() if key not in ("examples", "default")}
            alternatives = [node[key] for key in ("oneOf", "anyOf") if key in node]
            assert all({} in each for each in alternatives), "what refuses as one of several, nobody understands"
            assert node.get("$ref", "#").startswith("#")
            if node.get("properties"):
                rest = node.get("additionalProperties")
                assert rest is False or {"type", "$ref"} & rest.keys()
            for key, child in node.items():  # the keys of `properties` are names, not keywords
                waiting += child.values() if key in ("properties", "$defs") else [child]
        elif isinstance(node, list):
            waiting += node


def test_every_kind_has_its_schema() -> None:
    assert {f"{kind}.schema.json" for kind in file_kinds()} == {p.name for p in schema_folder().glob("*.schema.json")}


def test_a_sound_document_is_returned_as_it_is() -> None:
    data, report = check("states: {a: {on: {go: b}}, b: {}}")
    assert data is report.document.data
    assert not report.diagnostics


def test_broken_nodes_go_and_the_rest_stays() -> None:
    data, report = check("states: {a: {on: {go: 3}, entry: {say: hi}}, b: []}")
    assert data == {"states": {"a": {"on": {}, "entry": {"say": "hi"}}}}
    assert {d.code for d in report.diagnostics} == {"wrong-type"}
    assert ("states", "b") in report.pruned
    assert "b" in report.lost


def test_items_of_a_list_keep_their_places() -> None:
    text = "states:\n  a:\n    entry:\n      - {sya: x}\n      - {say: y}\n      - 3\n      - {play: z}\n"
    data, report = check(text)
    assert data["states"]["a"]["entry"] == [{"say": "y"}, {"play": "z"}]
    assert report.document.place(("states", "a", "entry", 0)).line == 5
    assert report.document.place(("states", "a", "entry", 1, "play")).line == 7
    assert [d.place.line for d in report.diagnostics] == [6, 4] or [d.place.line for d in report.diagnostics] == [4, 6]


def test_a_missing_key_takes_its_parent_along_but_never_the_root() -> None:
    data, report = check("robot: {}\nroutes: {face: {direction: in}}", "lumen")
    assert data == {"routes": {}}
    assert [d.code for d in report.diagnostics].count("missing-key") == 4
    assert ("routes", "face") in report.pruned


def test_a_misspelt_required_key_is_one_finding() -> None:
    _, report = check("state: {a: {}}")
    assert [d.code for d in report.diagnostics] == ["unknown-key"]


def test_what_follows_from_a_lost_node_is_not_said() -> None:
    _, report = check("states: {a: {on: {go: b}}, b: []}")
    report(UNKNOWN_STATE, ("states", "a", "on", "go"), "there is no state `b`")
    report(UNKNOWN_STATE, ("states", "a", "on", "go"), "there is no state `#guide.b`")
    report(UNKNOWN_STATE, ("states", "a", "on", "go"), "there is no state `c`")
    assert [d.message for d in report.diagnostics if d.code == "unknown-state"] == ["there is no state `c`"]


def test_a_root_of_the_wrong_type_leaves_nothing() -> None:
    data, report = check("[1, 2]")
    assert data is None
    assert [d.code for d in report.diagnostics] == ["wrong-type"]


def test_the_editors_line_of_every_file_leads_to_its_schema() -> None:
    root = schema_folder().parent
    for file in [
        root / "lumen.yaml",
        *matching(root, "behaviors/**/*.yaml", "fuzzy/*.yaml", "motions/*.yaml"),
    ]:
        first = file.read_text().split("\n", 1)[0]
        assert first.startswith("# yaml-language-server: $schema="), file
        schema = (file.parent / first.rpartition("=")[2]).resolve()
        assert json.loads(schema.read_text())["$id"], file


def test_a_key_with_an_apostrophe_that_is_missing_is_named() -> None:
    [found] = faults({"a": 1}, {"type": "object", "required": ["a", "it's"]})
    assert found.message.endswith("needs the key `it's`")


def test_more_keys_than_are_allowed_are_counted() -> None:
    many = "\n".join(f"  way{i}: {{joint: HeadYaw, amplitude: 1, period: 2s}}" for i in range(51))
    _, report = check(f"sways:\n{many}\n", "life")
    assert [d.message for d in report.diagnostics if "51" in d.message] == [
        "`sways` has 51 keys, but should have at most 50"
    ]


@for_each(
    "states",
    [
        "".join(f"  s{i}:\n    on: {{go: s0}}\n    gaurds: {i}\n" for i in range(1_700)),
        "".join(f"  s{i}:\n    on:\n      go: s0\n      after: {{9s: s0}}\n" for i in range(1_700)),
        "  s0:\n    on: {go: s1}\n  after: {3s: s1}\n  s1:\n" + 5_000 * "    # a comment of thirty letters\n",
    ],
    ids=lambda states: states[:50],
)
def test_a_large_file_is_read_again_for_few_moves_of_its_lines(states: str, monkeypatch: pytest.MonkeyPatch) -> None:
    tried: list[str] = []
    sought: list[Complaint] = []
    moves = misindented._moves

    def read(text: str) -> Document | None:
        tried.append(text)
        return read_text(text)

    def seek(complaint: Complaint, *of: Any) -> Iterator[Any]:
        sought.append(complaint)
        return moves(complaint, *of)

    monkeypatch.setattr(schema, "read_text", read)
    monkeypatch.setattr(misindented, "_moves", seek)
    check(f"states:\n{states}")
    assert sum(map(len, tried)) <= misindented.MAX_CHARACTERS
    assert len(sought) <= misindented.MAX_COMPLAINTS
    assert sought
