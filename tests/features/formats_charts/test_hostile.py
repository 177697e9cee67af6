"""Files of another kind than they claim, or of a hostile size, are refused in one clear line."""

import json
from collections.abc import Callable, Iterator
from contextlib import suppress
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lumen.errors import ProjectError
from lumen.features.formats_charts.scxml import read_scxml
from lumen.features.formats_charts.xstate import read_xstate
from lumen.language.diagnostics import has_errors
from lumen.project.formats.conversion_findings import ForeignFileError
from lumen.statechart import Machine
from tests.tables import for_each

Reader = Callable[[str, bytes, str], Any]
HEAD = b'<scxml xmlns="http://www.w3.org/2005/07/scxml" datamodel="ecmascript">'
BOMB = b"".join(
    [
        b'<!DOCTYPE x [<!ENTITY a0 "ha">',
        *(b'<!ENTITY a%d "&a%d;&a%d;">' % (n, n - 1, n - 1) for n in range(1, 40)),
        b"]>",
    ]
)
FETCH = b'<!DOCTYPE x [<!ENTITY f SYSTEM "file:///etc/hostname">]>'


HOSTILE_XML: list[tuple[bytes, int, str]] = [
    (b"", 1, "no element found"),
    (b"hello", 1, "syntax error"),
    (b"<scxml>\n<state>\n</scxml>", 3, "mismatched tag"),
    (b"<html/>", 1, "begins with <html>"),
    (HEAD + b"</scxml>", 1, "has no states"),
    (BOMB + HEAD + b"<state id='&a39;'/></scxml>", 1, "document type"),
    (b"\n" + FETCH + HEAD + b"<state id='&f;'/></scxml>", 2, "document type"),
    (b'<?xml version="1.0" encoding="klingon"?><scxml/>', 1, "encoding"),
    (b'<?xml version="1.0" encoding="UTF-8"?><scxml name="\xff"/>', 1, "not well-formed"),
    ("<scxml/>".encode("utf-32"), 1, "this is not XML"),
    (HEAD + b"<state>" * 200 + b"</state>" * 200 + b"</scxml>", 1, "100 levels"),
    (HEAD + b"<state/>" * 60_000 + b"</scxml>", 1, "50,000 elements"),
    (HEAD + b" " * 10_000_000 + b"</scxml>", 1, "10 MB"),
]


@for_each(("content", "line", "words"), HOSTILE_XML)
def test_hostile_xml(content: bytes, line: int, words: str) -> None:
    refused(read_scxml, content, line, words)


HOSTILE_JSON: list[tuple[bytes, int, str]] = [
    (b"", 1, "not JSON"),
    (b'{"states": {\n"a" 1}}', 2, "delimiter"),
    (b"[1, 2]", 1, "not an XState machine"),
    (b'{"id": "x", "states": {}}', 1, "not an XState machine"),
    (b'{"states": {"a": {"x": NaN}}}', 1, "not a number"),
    (b'{"states": \xff}', 1, "encoding"),
    (b"[" * 100_000, 1, "nested"),
    (b'{"states":{"a":' * 60 + b"1" + b"}}" * 60, 1, "95 levels"),
    (b'{"states":' + b" " * 10_000_000 + b"1}", 1, "10 MB"),
]


@for_each(("content", "line", "words"), HOSTILE_JSON)
def test_hostile_json(content: bytes, line: int, words: str) -> None:
    refused(read_xstate, content, line, words)


def refused(read: Reader, content: bytes, line: int, words: str) -> None:
    with pytest.raises(ForeignFileError) as raised:
        read("chart", content, "chart")
    diagnostic = raised.value.diagnostic
    assert words in diagnostic.message + diagnostic.hint
    assert diagnostic.place.line == line
    assert "\n" not in str(diagnostic)


def test_states_nested_too_deeply_are_left_out_and_listed() -> None:
    chart = HEAD + b"".join(b'<state id="s%d">' % n for n in range(60)) + b"</state>" * 60 + b"</scxml>"
    data, diagnostics = read_scxml("chart", chart, "chart")
    assert [d.message for d in diagnostics] == ["`s40` is nested more than 40 levels deep"]
    Machine.from_dict(data)


TAGS = ["state", "parallel", "final", "history", "initial", "transition", "onentry", "onexit", "send", "raise", "if",
        "else", "assign", "datamodel", "data", "donedata", "param", "content", "log", "invoke", "cancel"]  # fmt: skip
VALUES = st.sampled_from(
    ["a", "b", "a b", "x", "1", "x + 1", "In('a')", "'", "a.*", "*", "", "2s", "#_internal", "_event.data.x"]
)
NAMES = ["id", "event", "target", "cond", "expr", "location", "type", "initial", "delay", "sendid", "name", "src"]


def xml(tag: str, attributes: dict[str, str], children: list[str]) -> str:
    pairs = "".join(f' {key}="{value}"' for key, value in attributes.items())
    return f"<{tag}{pairs}>{''.join(children)}</{tag}>"


ELEMENTS = st.recursive(
    st.builds(xml, st.sampled_from(TAGS), st.dictionaries(st.sampled_from(NAMES), VALUES, max_size=4), st.just([])),
    lambda inner: st.builds(
        xml,
        st.sampled_from(TAGS),
        st.dictionaries(st.sampled_from(NAMES), VALUES, max_size=4),
        st.lists(inner, max_size=4),
    ),
    max_leaves=20,
)


@pytest.mark.slow
@settings(max_examples=150, deadline=None)
@given(st.lists(ELEMENTS, min_size=1, max_size=5))
def test_any_elements_give_a_machine_or_a_line(elements: list[str]) -> None:
    content = HEAD + "".join(elements).encode() + b"</scxml>"
    builds(read_scxml, content)


KEYS = st.sampled_from([
    "states", "a", "b", "on", "target", "guard", "actions", "entry", "type", "id", "initial", "after", "always",
    "params", "onDone", "invoke", "src", "input", "context", "meta", "lumen", "100", "history", "output", "reenter",
    "description", "steps", "say", "value",
])  # fmt: skip
JSON_VALUES = st.recursive(
    st.sampled_from([None, True, 1, 0.5, "a", "b", ".a", "#a", "*", "a.*", "", "history", "final", "parallel"]),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(KEYS, inner, max_size=5),
    max_leaves=25,
)


@pytest.mark.slow
@settings(max_examples=150, deadline=None)
@given(st.dictionaries(st.sampled_from(["a", "b", "c d"]), JSON_VALUES, min_size=1, max_size=3), JSON_VALUES)
def test_any_json_gives_a_machine_or_a_line(states: dict[str, Any], on: Any) -> None:
    builds(read_xstate, json.dumps({"states": states, "on": on, "context": on, "meta": on}).encode())


def builds(read: Reader, content: bytes) -> None:
    """Check that the file is refused in a line, or becomes a machine without errors."""
    with suppress(ForeignFileError):
        data, _ = read("chart", content, "chart")
        build(data)


def build(data: dict[str, Any]) -> None:
    try:
        Machine.from_dict(data)
    except ProjectError as error:
        raise AssertionError([str(d) for d in error.diagnostics]) from None


def test_what_is_whole_is_not_complained_of() -> None:
    chart = HEAD + b'<state id="a"><transition event="e" target="b"/></state><final id="b"/></scxml>'
    assert not has_errors(read_scxml("chart", chart, "chart")[1])


def large_files() -> Iterator[tuple[Reader, bytes]]:
    """Yield charts of ten thousand states, of transitions whose order no map can keep, and of chained assignments."""
    order = b'<transition event="e%d.x"/><transition event="e%d"/><transition event="e%d.x"/>'
    chart = [
        b'<state id="s%d"><transition event="e" target="s%d"/></state>' % (n, (n + 1) % 10_000) for n in range(10_000)
    ]
    data = [b'<data id="x%d" expr="0"/>' % n for n in range(3_000)]
    chain = [b'<assign location="x%d" expr="x%d"/>' % (n, n + 1) for n in range(2_999)]
    mixed = [order % (n, n, n) for n in range(3_000)]
    yield read_scxml, HEAD + b"".join(chart) + b"</scxml>"
    rest = b"<datamodel>%s</datamodel><state><onentry>%s</onentry>%s</state></scxml>"
    yield read_scxml, HEAD + rest % (b"".join(data), b"".join(chain), b"".join(mixed))
    states = {f"s{n}": {"on": {"e": f"s{(n + 1) % 10_000}"}} for n in range(10_000)}
    yield read_xstate, json.dumps({"states": states}).encode()


@pytest.mark.slow
def test_ten_thousand_states_are_read_whole() -> None:
    assert [read("chart", content, "chart")[1] for read, content in large_files()] == [[], [], []]
