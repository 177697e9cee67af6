"""A fault in an expression is found at its very word, however the text is written in YAML."""

import yaml
from hypothesis import given
from hypothesis import strategies as st

from lumen.project.document import Document
from lumen.project.expressions import place_within
from lumen.project.yaml_reader import parse
from tests.tables import for_each

WRITTEN = {
    "plain": "a: one HERE two\n",
    "plain over lines": "a: one\n  two\n\n  HERE two\n",
    "single quotes": "a: 'it''s HERE'\n",
    "single quotes over lines": "a: 'it''s\n  a HERE'\n",
    "double quotes": 'a: "\\u00e9\\x41\\t\\"\\n HERE \\\\"\n',
    "double quotes over lines": 'a: "one \\\n    two\\\n  \\ HERE"\n',
    "literal": "a: |\n  one\n    two HERE\n  three\n",
    "literal with a header": "a: |2- # why\n    one\n  two HERE\n",
    "folded": "a: >-\n  one\n  two\n\n    HERE\n  more\n",
    "in a flow map": "a: {b: ['x', \"y\", 'it''s HERE']}\n",
    "with an anchor": "a: &name 'it''s HERE'\n",
    "with a tag": "a: !!str 'it''s HERE'\n",
    "Windows": "a: |\r\n  one\r\n  HERE\r\n",
    "other planes": "a: '😀''s HERE'\n",
}


def document_of(text: str) -> tuple[Document, tuple[str | int, ...], str]:
    document, _ = parse("a.yaml", text.encode())
    assert document is not None
    path, value = list(document.spans)[-1], document.data
    for step in path:
        value = value[step]
    return document, path, value


@for_each("text", WRITTEN.values(), ids=WRITTEN)
def test_at_the_word(text: str) -> None:
    document, path, value = document_of(text)
    place = place_within(document, path, value, value.index("HERE"), 4)
    assert place.line == place.end_line
    assert text.splitlines()[place.line - 1][place.column - 1 : place.end_column - 1] == "HERE"


def test_an_escape_is_one_character() -> None:
    document, path, value = document_of('a: "\\u00e9 \\"x"\n')
    place = place_within(document, path, value, value.index('"'), 1)
    assert (place.column, place.end_column) == (12, 14)


@for_each("offset", [0, 3, 7, 8, 100])
def test_blanks_and_the_end_are_somewhere_in_it(offset: int) -> None:
    document, path, value = document_of("a: |\n  one\n\n  two\n")
    place = place_within(document, path, value, offset, 1)
    assert 2 <= place.line <= place.end_line <= 4


def test_a_text_of_blanks_is_meant_as_a_whole() -> None:
    document, path, value = document_of('a: "\\n \\t"\n')
    assert place_within(document, path, value, 0, 1) == document.place(path)


@given(
    st.text(st.characters(codec="utf-8", exclude_categories=["Cs"]), min_size=1), st.sampled_from("'\"|> "), st.data()
)
def test_any_text_in_any_style(value: str, style: str, data: st.DataObject) -> None:
    """Text written by PyYAML is located character by character; otherwise the place is the whole text."""
    text = yaml.dump(
        {"a": value}, default_style=style.strip() or None, allow_unicode=data.draw(st.booleans()), width=20
    )
    document, _ = parse("a.yaml", text.encode())
    if document is None or document.data["a"] != value:
        return
    at = data.draw(st.integers(0, len(value) - 1))
    place = place_within(document, ("a",), value, at, 1)
    whole = document.place(("a",))
    assert (whole.line, whole.column) <= (place.line, place.column) <= (place.end_line, place.end_column)
    assert (place.end_line, place.end_column) <= (whole.end_line, whole.end_column)
    if value.isascii() and value.isalnum() and style != " ":
        line = text.splitlines()[place.line - 1]
        assert line[place.column - 1 : place.end_column - 1] == value[at]
