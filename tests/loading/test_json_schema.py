"""A quick yes is never wrong, and the shipped files get one: jsonschema is not even imported for them."""

import json
from random import Random
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from jsonschema import Draft202012Validator

from lumen.expressions.json_schema import MAX_DATA_DEPTH, JsonSchema
from lumen.project.document import MAX_NODE_DEPTH, Document
from lumen.project.files import read_files
from lumen.project.messages import build_message
from lumen.project.project_folders import file_kinds, kind_of
from lumen.project.schema import load_schema
from lumen.project.yaml_reader import parse
from tests import ROOT
from tests.tables import for_each

SHIPPED = read_files(ROOT)


def documents() -> list[tuple[str, Document]]:
    found = []
    for file, content in SHIPPED.items():
        kind = kind_of(file)
        document = parse(file, content)[0] if kind else None
        if document:
            found.append((kind, document))
    return found


DOCUMENTS = documents()
QUICK = {kind: JsonSchema(load_schema(kind)) for kind in file_kinds()}
VALIDATORS = {kind: Draft202012Validator(load_schema(kind)) for kind in file_kinds()}
SMALL = [(kind, document) for kind, document in DOCUMENTS if len(document.spans) < 200]
VALUES = [
    None,
    True,
    0,
    -1,
    1.5,
    1e400,
    float("nan"),
    "",
    "x",
    "2s",
    [],
    {},
    [1, 2],
    ["a", "a"],
    {"a": 1},
    {"if": "true"},
]


@for_each(("kind", "document"), [pytest.param(*d, id=d[1].file) for d in DOCUMENTS])
def test_every_shipped_file_gets_a_quick_yes(kind: str, document: Document) -> None:
    assert QUICK[kind].fits(document.data)


@pytest.mark.slow
@settings(max_examples=250)
@given(st.sampled_from(SMALL), st.randoms(use_true_random=False))
def test_a_quick_yes_is_never_wrong(chosen: tuple[str, Document], random: Random) -> None:
    """One or two values of a shipped file are taken away, added, or put in another's place."""
    kind, document = chosen
    data = _copy(document.data)
    for _ in range(random.choice([1, 1, 2])):
        _change(data, random)
    assert not QUICK[kind].fits(data) or VALIDATORS[kind].is_valid(data)


@for_each(
    ("schema", "fits", "fails"),
    [
        ({"patternProperties": {"^x": {"type": "string"}}, "additionalProperties": False}, {"xa": "b"}, {"a": "b"}),
        ({"prefixItems": [{"type": "number"}], "items": False}, [1], [1, 2]),
        ({"if": {"type": "string"}, "then": {"enum": ["a"]}, "else": {"minimum": 2}}, 3, "b"),
        ({"if": {"minimum": 2}, "then": {"maximum": 3}, "else": {"maximum": 1}}, 2, 1.5),
        ({"anyOf": [{"type": "string"}, {"type": "null"}]}, None, 1),
        ({"const": 1}, 1, True),
        ({"uniqueItems": True}, ["a", "b"], ["a", "a"]),
        ({"dependentRequired": {"a": ["b"]}}, {"b": 1}, {"a": 1}),
        ({"propertyNames": {"maxLength": 1}}, {"a": 1}, {"ab": 1}),
        ({"$ref": "#/$defs/a/items", "$defs": {"a": {"items": {"type": "null"}}}}, None, 1),
        ({"oneOf": [{"type": "string"}, {"minLength": 1}]}, "", "a"),
        ({"not": {"type": "null"}}, 1, None),
        ({"format": "x", "type": "string"}, "a", 1),
        ({"$ref": "#/$defs/tree", "$defs": {"tree": {"items": {"$ref": "#/$defs/tree"}, "type": "array"}}}, [[]], [1]),
    ],
)
def test_keywords(schema: dict[str, Any], fits: Any, fails: Any) -> None:
    assert JsonSchema(schema).fits(fits)
    assert Draft202012Validator(schema).is_valid(fits)
    assert not JsonSchema(schema).fits(fails)
    assert not Draft202012Validator(schema).is_valid(fails)


@pytest.mark.parametrize(
    "schema",
    [
        {"$ref": "other"},
        {"$ref": "#/$defs/none"},
        False,
    ],
)
def test_nobody_knows(schema: Any) -> None:
    assert not JsonSchema(schema).fits(1)


def _copy(data: Any) -> Any:
    if isinstance(data, dict):
        return {key: _copy(value) for key, value in data.items()}
    return [_copy(value) for value in data] if isinstance(data, list) else data


def _change(data: Any, random: Random) -> None:
    node, inner = data, data
    while isinstance(inner, dict | list) and inner and random.random() < 0.9:
        node = inner
        inner = node[random.choice(list(node) if isinstance(node, dict) else range(len(node)))]
    value = random.choice([*VALUES, inner])
    if isinstance(node, list):
        node.insert(random.randrange(len(node) + 1), value)
    elif node and random.random() < 0.7:
        key = random.choice(list(node))
        node[key] = value
        if random.random() < 0.3:
            del node[key]
    else:
        node[random.choice(["x", "at", "id", *node])] = value


def _nested(levels: int) -> Any:
    data: Any = 1
    for level in range(levels):
        data = [data] if level % 2 else {"a": data}
    return data


@pytest.mark.parametrize("schema", [{}, {"items": {"$ref": "#"}, "properties": {"a": {"$ref": "#"}}}])
def test_data_in_which_jsonschema_rs_would_end_the_process_is_not_given_to_it(schema: Any) -> None:
    assert JsonSchema(schema).fits(_nested(MAX_DATA_DEPTH))
    assert not JsonSchema(schema).fits(_nested(MAX_DATA_DEPTH + 1))
    deep = _nested(50_000)
    assert not JsonSchema(schema).fits(deep)
    with pytest.raises(RecursionError):
        next(JsonSchema(schema).errors(deep))


def test_a_schema_that_nests_too_deep_fits_nothing() -> None:
    assert not JsonSchema({"const": _nested(50_000)}).fits(1)


def test_a_message_schema_that_is_nested_too_deep_is_not_read() -> None:
    content = [b'{"items":' * depth + b"{}" + b"}" * depth for depth in (MAX_NODE_DEPTH - 1, MAX_NODE_DEPTH)]
    assert build_message("x.schema.json", content[0])[1] == ()
    read, (found,) = build_message("x.schema.json", content[1])
    assert read is None
    assert (found.code, found.message) == ("too-large", f"the file is nested deeper than {MAX_NODE_DEPTH} levels")


@pytest.mark.parametrize("reference", ["#/anyOf/" + "9" * 5_000, "#/anyOf/\u0663", "#/anyOf/-1", "#/anyOf/0"])
def test_a_reference_to_a_place_in_a_list(reference: str) -> None:
    content = json.dumps({"items": {"$ref": reference}, "anyOf": [True]}).encode()
    assert ([d.code for d in build_message("x.schema.json", content)[1]] == []) == reference.endswith("/0")
