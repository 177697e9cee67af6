"""Nodes from events: equal to those of libyaml's own composer for sound files, and cut short for too large files."""

from pathlib import Path

import pytest
import yaml

from lumen.project.packaged import shipped_root
from lumen.project.yaml_composer import TooLargeError, compose
from lumen.project.yaml_reader import parse
from tests.scanning import matching
from tests.tables import for_each

FILES = matching(shipped_root(), "behaviors/*.yaml", "fuzzy/*.yaml", "motions/*.yaml")

DEEP = {
    "flow lists": "[" * 60_000,
    "flow maps": "{a: " * 60_000,
    "block lists": "- " * 60_000,
    "explicit keys": "? " * 60_000,
    "keys of flow maps": "{? " * 60_000,
    "both kinds": "{a: [" * 60_000,
    "anchors": "".join(f"&a{i} [" for i in range(60_000)),
    "tags": "!x [" * 60_000,
    "indented keys": "".join(f"{' ' * i}a:\n" for i in range(1_000)),
}
LONG = {
    "pairs": "{" + "a," * 101_000 + "}",
    "aliases": "- &a x\n" + "- *a\n" * 201_000,
    "tag directives": "".join(f"%TAG !a{i}! tag:x{i}:\n" for i in range(150_000)) + "--- x",
}


class Composer(yaml.CSafeLoader):
    """libyaml's own, which resolves no scalars."""


Composer.yaml_implicit_resolvers = {}


def shape(node: yaml.Node | None) -> object:
    assert node is not None
    own = node.tag, node.start_mark.index, node.end_mark.index
    if isinstance(node, yaml.ScalarNode):
        return *own, node.value, node.style
    return *own, [shape(n) if isinstance(n, yaml.Node) else tuple(map(shape, n)) for n in node.value]


@for_each("file", FILES, ids=lambda path: path.stem)
def test_it_is_what_libyaml_composes(file: Path) -> None:
    assert shape(compose(file.read_text())) == shape(yaml.compose(file.read_text(), Composer))


@pytest.mark.parametrize("text", ["a: &x [1, {b: 2}]\nc: *x", "? [k]\n: v", "- !t x\n- |\n  y\n", "--- >-\n x\n...\n"])
def test_anchors_tags_and_keys_are_what_libyaml_composes(text: str) -> None:
    assert shape(compose(text)) == shape(yaml.compose(text, Composer))


@for_each("text", ["*x", "a\n---\nb", "a: b: c", "[1", "\0"])
def test_what_is_no_yaml_is_told_as_libyaml_tells_it(text: str) -> None:
    with pytest.raises(yaml.YAMLError) as ours:
        compose(text)
    with pytest.raises(yaml.YAMLError) as theirs:
        yaml.compose(text, Composer)
    assert str(ours.value) == str(theirs.value)


@pytest.mark.parametrize("text", ["", "# a comment", "%YAML 1.2\n"])
def test_nothing_is_none_or_a_fault(text: str) -> None:
    try:
        assert compose(text) is None
    except yaml.YAMLError:
        assert text.startswith("%")


@for_each("kind", DEEP)
def test_what_is_nested_too_deep_ends_the_reading_at_its_place(kind: str) -> None:
    document, [found] = parse("behaviors/notes.yaml", DEEP[kind].encode())
    assert document is None
    assert found.code == "too-large"
    assert "nested deeper than 100 levels" in found.message
    assert (found.place.line, found.place.column) > (1, 1)


@pytest.mark.parametrize("kind", LONG)
def test_what_holds_too_many_nodes_ends_the_reading(kind: str) -> None:
    with pytest.raises(TooLargeError, match="more than"):
        compose(LONG[kind])


def test_aliases_are_counted_as_what_they_stand_for() -> None:
    lines = ["a0: &a0 [x, x, x, x, x, x, x, x, x, x]"]
    lines += [f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]" for i in range(1, 12)]
    with pytest.raises(TooLargeError, match="more than 200,000 values") as raised:
        compose("\n".join(lines))
    assert raised.value.mark.line == 5


@pytest.mark.parametrize("text", ["&a [*a]", "a: &x {b: [*x]}", "? &a [*a]\n: b", "&a {*a : b}"])
def test_an_alias_within_what_it_stands_for_is_refused(text: str) -> None:
    with pytest.raises(TooLargeError, match="refers to the node that contains it"):
        compose(text)


@pytest.mark.parametrize("digits", ["0x" + "f" * 5_000, "0o" + "7" * 5_000, "9" * 5_000, "0x" + "f" * 300])
def test_integers_of_thousands_of_digits_are_no_integers(digits: str) -> None:
    document, found = parse("a.yaml", f"a: {digits}".encode())
    assert document
    assert document.data == {"a": float("inf")}
    assert not found
