"""Statecharts in SCXML from bug reports and other systems: nothing is lost or misread without a finding."""

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from lumen.features.formats_charts.scxml import read_scxml, write_scxml
from lumen.features.formats_charts.scxml.known import ATTRIBUTES, ELEMENTS
from lumen.language.diagnostics import Diagnostic, has_errors
from lumen.project.formats.conversion_findings import ForeignFileError, dotted
from lumen.statechart import Interpreter, Machine
from tests.tables import for_each

INPUTS = Path(__file__).parent / "inputs" / "charts"
HEAD = '<scxml xmlns="http://www.w3.org/2005/07/scxml" xmlns:lumen="urn:lumen:behavior" xmlns:qt="urn:qt">'


def scxml(name: str) -> tuple[dict[str, Any], list[Diagnostic]]:
    return read_scxml(name, (INPUTS / name).read_bytes(), "chart")


def body(text: str) -> tuple[dict[str, Any], list[str]]:
    """Return the data and the findings of a chart with this text as its content."""
    data, found = read_scxml("chart.scxml", f"{HEAD}{text}</scxml>".encode(), "chart")
    Machine.from_dict(data)
    return data, messages(found)


def messages(found: list[Diagnostic]) -> list[str]:
    return [f"{d.place.line}:{d.place.column} {d.message}" + (f" ({d.hint})" if d.hint else "") for d in found]


def test_a_misspelt_attribute_is_listed_at_its_place() -> None:
    _, found = scxml("attribute-slip.scxml")
    assert messages(found) == ["2:29 `events` of `<transition>` has no counterpart in Lumen (did you mean `event`?)"]
    assert has_errors(found)


def test_a_guard_that_is_no_attribute_is_listed_and_case_is_accepted() -> None:
    data, found = scxml("attribute-guard.scxml")
    assert messages(found) == [
        "2:39 `guard` of `<transition>`: write `cond`",
        '3:33 `type` of `<history>` is read as `deep` (write "deep")',
    ]
    assert data["states"]["b"]["states"]["h"]["history"] == "deep"


def test_data_declared_twice_is_listed() -> None:
    data, found = scxml("data-twice.scxml")
    hint = "give each its own id: data is visible in the whole chart"
    assert messages(found) == [f"3:34 a second `<data>` has the id `TIMEOUT` ({hint})"]
    assert data["context"] == {"TIMEOUT": 100000}


def test_the_layout_of_an_editor_is_one_line_and_no_error() -> None:
    data, found = scxml("editor-layout.scxml")
    assert [(d.place.line, str(d.severity), "4 times" in d.message) for d in found] == [(2, "warning", True)]
    assert data["states"]["a"] == {"on": {"e": {"guard": "In('b')", "target": "b"}}}


def test_conditions_follow_a_renamed_id() -> None:
    data, found = scxml("renamed-in.scxml")
    assert [d.message for d in found] == ["the state `Talk#1` is renamed to `Talk_1` in the whole behaviour"]
    it = Interpreter(Machine.from_dict(data))
    it.start()
    it.send("f")
    assert {"q2", "Talk_1"} <= set(it.configuration)


def test_done_events_follow_a_renamed_id() -> None:
    data, _ = scxml("renamed-done.scxml")
    it = Interpreter(Machine.from_dict(data))
    it.start()
    it.send("e")
    assert "End" in it.configuration


def test_ids_that_only_clash_after_renaming_stay_two() -> None:
    data, _ = body(
        '<state id="a#1"><transition event="e" target="a_1"/></state><state id="a_1">'
        '<transition event="e" cond="!In(\'a#1\') &amp;&amp; In(\'a_1\')" target="a*1"/></state>'
        '<state id="a*1"><transition event="done.state.a*1" cond="_event.name == \'done.state.a*1\'"'
        ' target="a#1"/><final id="z"/></state>'
    )
    it = Interpreter(Machine.from_dict(data))
    seen = [it.start(), it.send("e"), it.send("e")]
    assert [set(step.snapshot.configuration) - {""} for step in seen] == [{"a_1_2"}, {"a_1"}, {"a_1_2"}]


@for_each(
    ("text", "found"),
    [
        ('<state id="a" final="true"/>', "`final` of `<state>`: write `<final>`"),
        ('<state id="a"><transition event="e"><target next="b"/></transition></state><state id="b"/>',
         "`<target>`: write `target=` in the `<transition>`"),
        ('<state id="a"><onentry><var name="x" expr="1"/></onentry></state>',
         "`<var>`: declare it with `<data>` and set it with `<assign>`"),
        ('<state id="a"><onentry><qt:beep/></onentry></state>', "`<beep>` has no counterpart in Lumen"),
        ('<datamodel><data expr="1"/></datamodel><state id="a"/>', "a `<data>` has no `id`"),
        ('<datamodel><data name="x"/></datamodel><state id="a"/>', "`name` of `<data>`: write `id`"),
        ('<datamodel><data id="x" expr="1">2</data></datamodel><state id="a"/>',
         "`<data>` has `expr` and `text`: one of them is left out"),
        ('<state id="a"><log expr="1"/></state>', "`<log>` in `<state>` has no counterpart in Lumen"),
        ('<state id="a"><onentri/></state>', "`<onentri>` has no counterpart in Lumen (did you mean `<onentry>`?)"),
        ('<state id="a"><onentry>hello</onentry></state>', "the text in `<onentry>` has no counterpart in Lumen"),
        ('<state id="a"><transition event="e" type="inner" target="a"/></state>',
         '`type` of `<transition>` can\'t be `inner` (write "external" or "internal")'),
        ('<state id="a"><onentry><if cond="true"><log expr="1"/><else><log expr="2"/></else></if></onentry></state>',
         "`<log>` in `<else>` has no counterpart in Lumen (move it after `<else/>`)"),
        ('<state id="a"><onentry><if cond="true"/><send event="e"><param name="a" expr="1"/>'
         '<content>2</content></send></onentry></state>',
         "`<send>` has `<param>` and `<content>`: one of them is left out"),
        ('<state id="a"><onentry><send event="e"><param name="a" expr="1"/><param name="a" expr="2"/></send>'
         "</onentry></state>", "two `<param>` are named `a`: the last one is used"),
        ('<final id="a"><transition event="e" target="a"/></final>', "nothing follows a final state"),
        ('<parallel id="p" initial="a"><state id="a"/><state id="b"/></parallel>',
         "`initial` of `<parallel>`: a parallel state enters all of its states"),
        ('<state id="a"><initial><transition target="b" cond="true"/></initial><state id="b"/></state>',
         "`cond` is left out: a transition into a state has no event or condition"),
        ('<state id="a"><history id="h"><transition target="b"/><transition target="c"/></history>'
         '<state id="b"/><state id="c"/></state>', "a second `<transition>` in a `<history>`"),
        ('<state id="a"><lumen:do>[{"log": "x"}]</lumen:do><lumen:do>[{"log": "y"}]</lumen:do></state>',
         "a second `<lumen:do>` in a `<state>`"),
        ('<state id="a"><lumen:state>{"resume": "soon"}</lumen:state></state>',
         "`resume: soon` of `<lumen:state>` has no counterpart in Lumen"),
        ('<state id="a"><transition event="e" qt:cond="x" target="a"/></state>',
         "`cond` of the namespace `urn:qt` is ignored"),
        ('<state id="a"><invoke type="scxml" src="b.scxml" autoforward="yes"/></state>',
         "`autoforward` of `<invoke>` can't be `yes`"),
        ('<state id="a" initial="b"/><state id="b"/>', "`initial` of `a` is left out: the state has no inner states"),
        ('<state id="a"><initial><transition target="a"/></initial></state>', "`initial` of `a` is left out: the"),
        ('<state id="a"><state id="b"><transition event="e" target="b c"/></state><state id="c"/></state>',
         "`b` and `c` can't be active together"),
        ('<state id="a"><history id="h"/><transition event="e" target="h"/></state>', "there is no state `h` to go to"),
        ('<state id="a"><history id="h"><transition target="i"/></history><history id="i"/><state id="b"/></state>',
         "a history can't lead to a history"),
        ('<qt:group><state id="a"/></qt:group><state id="b"/>', "`<state>` in `<group>` is not read"),
        ('<state id="a"><invoke id="q" src="q.scxml"/><invoke id="q" src="r.scxml"/></state>',
         "`<invoke>`: a second `<invoke>` has the id `q`"),
        ('<state id="a"><invoke src="q.scxml" srcexpr="n"/></state>',
         "`<invoke>`: a computed or inline chart is not carried over"),
        ('<state id="a"><onentry><send event="e"><content><p/></content></send></onentry></state>',
         "`<content>` is XML (write it as JSON)"),
        ('<state id="a"><invoke src="q.scxml"><finalize><log expr="1"/></finalize></invoke></state>',
         "`<finalize>` has no counterpart in Lumen"),
    ],
)  # fmt: skip
def test_unread_content_is_listed(text: str, found: str) -> None:
    said = read_scxml("chart.scxml", f"{HEAD}{text}</scxml>".encode(), "chart")[1]
    assert any(found in message for message in messages(said)), messages(said)


def test_a_second_line_of_a_tag_has_its_own_place() -> None:
    _, found = body('\n<state id="ä"><transition\n  event="e"\n  évents = "x>y" target="ä"/></state>')
    assert [message.partition(" ")[0] for message in found] == ["4:3"]


def test_a_chart_that_is_invoked_twice_has_two_ids() -> None:
    text = (
        '<state id="a"><invoke src="q.scxml"/><invoke id="q" src="q.scxml"/></state>'
        '<parallel id="p"><state id="b"><invoke src="r.scxml"/></state><state id="c"><invoke src="r.scxml"/></state>'
        '</parallel><state id="d"><invoke src="r.scxml"/></state>'
    )
    data, _ = read_scxml("chart.scxml", f"{HEAD}{text}</scxml>".encode(), "chart")
    states = data["states"]
    assert states["a"]["invoke"] == [{"behavior": "q", "id": "q_2"}, {"behavior": "q"}]
    regions = states["p"]["states"]
    assert [regions["b"]["invoke"], regions["c"]["invoke"]] == [{"behavior": "r"}, {"behavior": "r", "id": "r_2"}]
    assert states["d"]["invoke"] == {"behavior": "r"}  # never at the same time as the others


@for_each(
    ("attributes", "found"),
    [
        ('version="1.0" datamodel="ecmascript"', []),
        ('version="2.0"', ['1:48 version `2.0` is read as 1.0 (write "1.0", the only version)']),
        (
            'datamodel="null"',
            ['1:48 the data model `null` does not allow `<data>`: it is read as ECMAScript (write "ecmascript")'],
        ),
    ],
)
def test_attributes_of_the_whole_document(attributes: str, found: list[str]) -> None:
    text = f'<scxml xmlns="http://www.w3.org/2005/07/scxml" {attributes}>'
    text += '<datamodel><data id="n" expr="1"/></datamodel><state id="a"/></scxml>'
    assert messages(read_scxml("chart.scxml", text.encode(), "chart")[1]) == found


def test_buttons_come_back_from_scxml() -> None:
    chart: dict[str, Any] = {"id": "c", "buttons": [{"label": "Go", "event": "go"}], "initial": "a",
             "states": {"a": {"buttons": [{"label": "On", "event": "on"}]}}}  # fmt: skip
    text, _ = write_scxml(Machine.from_dict(chart), dotted("c"))
    data, _ = read_scxml("c.scxml", text.encode(), "c")
    assert data == chart


def test_every_element_has_its_attributes_in_a_table() -> None:
    named = {name for known in ELEMENTS.values() for name in known.read}
    assert named <= ATTRIBUTES.keys()


_SAME = {"true": "false", "deep": "shallow", "internal": "external", "late": "early"}
_OF_NO_MEANING = {
    'version="1.0"', 'datamodel="ecmascript"', 'binding="early"',  # defaults, or attributes of every file
    'initial="hall"', 'initial="waiting"', 'type="scxml"', 'id="quiz"', 'target="waiting"',
}  # fmt: skip


def changed_attributes(text: str) -> Iterator[tuple[str, str]]:
    """Yield each attribute with documents in which it is renamed, removed or has another value."""
    for match in re.finditer(r'\s([\w:]+)="([^"]*)"', text):
        name, value = match.groups()
        if not name.startswith("xmlns"):
            for new in (f'{name}x="{value}"', "", f'{name}="{value}q"', f'{name}="{_SAME.get(value, value + "0")}"'):
                yield match[0].strip(), f"{text[: match.start()]} {new}{text[match.end() :]}"


def test_no_change_of_an_attribute_is_silent() -> None:
    text = (INPUTS / "rich.scxml").read_text("utf-8")

    def read(changed: str) -> Any:
        try:
            data, found = read_scxml("rich.scxml", changed.encode(), "rich")
        except ForeignFileError as error:
            return str(error.diagnostic)
        return json.dumps(data), sorted((d.message, d.hint) for d in found)

    before = read(text)
    silent = {attribute for attribute, changed in changed_attributes(text) if read(changed) == before}
    assert silent == _OF_NO_MEANING


def test_no_change_of_an_element_is_silent() -> None:
    text = (INPUTS / "rich.scxml").read_text("utf-8")
    before = read_scxml("rich.scxml", text.encode(), "rich")
    seen = 0
    for match in re.finditer(r"<(\w+)([^<>]*)/>", text):
        for new in (f"<{match[1]}x{match[2]}/>", match[0] * 2):
            data, found = read_scxml(
                "rich.scxml", f"{text[: match.start()]}{new}{text[match.end() :]}".encode(), "rich"
            )
            same = (data, [d.message for d in found]) == (before[0], [d.message for d in before[1]])
            assert not same, new
            seen += 1
    assert seen > 40
