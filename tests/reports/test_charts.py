"""Statecharts from bug reports and other systems: content that was once lost or misread is read correctly."""

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from lumen.errors import LumenError
from lumen.features.formats_charts.scxml import read_scxml, write_scxml
from lumen.features.formats_charts.scxml.known import ATTRIBUTES, ELEMENTS
from lumen.features.formats_charts.xstate import read_xstate
from lumen.language.diagnostics import Diagnostic, has_errors, nearest
from lumen.lint import check_files
from lumen.project.formats.conversion_findings import ForeignFileError, dotted
from lumen.project.yaml_reader import parse
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
    data, _ = body('<state id="a#1"><transition event="e" target="a_1"/></state><state id="a_1">'
                   '<transition event="e" cond="!In(\'a#1\') &amp;&amp; In(\'a_1\')" target="a*1"/></state>'
                   '<state id="a*1"><transition event="done.state.a*1" cond="_event.name == \'done.state.a*1\'"'
                   ' target="a#1"/><final id="z"/></state>')  # fmt: skip
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
        ('version="2.0"', ["1:48 version `2.0` is read as 1.0 (write \"1.0\", the only version)"]),
        ('datamodel="null"',
         ["1:48 the data model `null` does not allow `<data>`: it is read as ECMAScript (write \"ecmascript\")"]),
    ],
)  # fmt: skip
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


def xstate(source: str | dict[str, Any]) -> tuple[dict[str, Any], list[Diagnostic]]:
    """Read an input file or a machine; return its data and findings."""
    content = (INPUTS / source).read_bytes() if isinstance(source, str) else json.dumps(source).encode()
    data, found = read_xstate("chart.json", content, "chart")
    Machine.from_dict(data)
    return data, found


def test_a_state_of_version_4_that_is_its_own_target_is_left_and_entered() -> None:
    data, found = xstate("xstate4-self.json")
    it = Interpreter(Machine.from_dict(data))
    it.start()
    step = it.send("PING")
    assert (step.exited, step.entered) == (("waiting",), ("waiting",))
    assert [d.message for d in found] == ["the code of the guard `ready` is not in the file"]


@for_each(
    ("target", "way"),
    [
        ("b", {"target": "b"}),
        ({"target": "b", "internal": True}, {"target": ".b1"}),
        ("#deep", {"target": ".b2", "reenter": True}),
        (".b2", {"target": ".b2"}),
        ({"target": ".b2", "internal": False}, {"target": ".b2", "reenter": True}),
        ({"target": "b", "in": "#deep"}, {"target": "b", "guard": "In('deep')"}),
        ({"target": "b", "in": "#deep", "cond": "ready"}, {"target": "b", "guard": "In('deep') && (context.ready)"}),
    ],
)
def test_ways_within_a_state_of_version_4(target: Any, way: dict[str, Any]) -> None:
    states = {"b1": {}, "b2": {"id": "deep"}}
    chart = {"schema": {}, "initial": "b", "states": {"b": {"on": {"E": target}, "initial": "b1", "states": states}}}
    found = xstate(chart)[0]["states"]["b"]["on"]["E"]
    assert (found if isinstance(found, dict) else {"target": found}) == way


def test_sends_of_version_4_are_carried_over() -> None:
    data, found = xstate("xstate4-send.json")
    assert found == []
    assert data["states"]["a"] == {
        "entry": [{"send": {"event": "LATER", "delay": "1s", "id": "LATER"}}],
        "exit": [{"cancel": "LATER"}],
        "on": {"LATER": "b"},
    }


@for_each(
    ("action", "ours"),
    [
        ({"type": "xstate.raise", "event": "E"}, {"raise": "E"}),
        ({"type": "xstate.raise", "event": {"type": "E", "by": 1}}, {"raise": {"event": "E", "data": {"by": 1}}}),
        ({"type": "xstate.raise", "params": {"event": {"type": "E"}, "delay": 5}},
         {"send": {"event": "E", "delay": "5ms"}}),
        ({"type": "xstate.send", "event": {"type": "E"}}, {"send": "E"}),
        ({"type": "xstate.send", "event": {"type": "E"}, "to": "#_parent"}, {"send": {"event": "E", "to": "parent"}}),
        ({"type": "xstate.cancel", "sendId": "x"}, {"cancel": "x"}),
        ({"type": "xstate.log", "label": "at", "expr": 3}, {"log": "at: 3"}),
        ({"type": "xstate.assign", "assignment": {"n": 2, "t": "two"}}, {"assign": {"n": 2, "t": "'two'"}}),
    ],
)  # fmt: skip
def test_actions_of_xstate_itself(action: dict[str, Any], ours: dict[str, Any]) -> None:
    chart = {"context": {"n": 0, "t": ""}, "states": {"a": {"entry": action, "on": {"E": {}}}}}
    data, found = xstate(chart)
    assert (data["states"]["a"]["entry"], found) == ([ours], [])


@for_each(
    ("action", "found"),
    [
        ({"type": "xstate.send"}, "`xstate.send`: its event is not in the file"),
        ({"type": "xstate.send", "event": "E", "delay": "soon"},
         "`xstate.send`: the delay `soon` is not a number of milliseconds"),
        ({"type": "xstate.cancel"}, "`xstate.cancel`: `sendId` is not in the file"),
        ({"type": "xstate.log"}, "`xstate.log`: its code is not in the file"),
        ({"type": "xstate.assign", "assignment": {}}, "`xstate.assign`: its code is not in the file"),
        ({"type": "xstate.assign", "assignment": {"n": 1, "m": 1}}, "`m` is not in the context"),
        ({"type": "xstate.send", "event": "E", "dely": 3}, "`dely` of an xstate.send has no counterpart in Lumen"),
        ({"type": "xstate.send", "params": {"event": "E", "dely": 3}},
         "`dely` of an xstate.send has no counterpart in Lumen"),
        ({"type": "xstate.send", "event": "E", "params": {"event": "F"}},
         "`event` in `params` of an xstate.send is left out"),
        ({"type": "xstate.send", "event": "E", "params": "soon"}, "`params` of an xstate.send is not an object"),
    ],
)  # fmt: skip
def test_missing_parts_of_an_xstate_action_are_listed(action: dict[str, Any], found: str) -> None:
    said = xstate({"context": {"n": 0}, "states": {"a": {"entry": action, "on": {"E": {}}}}})[1]
    assert found in [d.message for d in said]


@for_each(
    ("state", "found"),
    [
        ({"onn": {"E": "a"}}, "`onn` of a state has no counterpart in Lumen"),
        ({"onEntry": "ring"}, "`onEntry` of a state: write `entry`"),
        ({"on": {"E": {"target": "a", "reenter": "yes"}}}, "`reenter` can't be `yes`"),
        ({"on": {"E": {"target": "a", "guards": "x"}}}, "`guards` of a transition has no counterpart in Lumen"),
        ({"on": {"E": {"target": "a", "guard": "x", "cond": "y"}}}, "`cond` beside `guard` is left out"),
        ({"on": {"E": {"target": "a", "in": "b.c"}}}, "`in`: the state `b.c` does not exist"),
        ({"initial": "x"}, "`initial` is left out: the state has no inner states"),
        ({"parallel": "yes"}, "`parallel` can't be `yes`"),
        ({"type": "Parallel", "states": {"x": {}}}, "unknown type of state `Parallel`"),
        ({"type": "parallel", "initial": "x", "states": {"x": {}, "y": {}}},
         "`initial` of a parallel state: it enters all of its states"),
        ({"initial": "x", "states": {"x": {}, "h": {"type": "history", "history": "Deep"}}},
         "`history` can't be `Deep`"),
        ({"initial": "x", "states": {"x": {}, "h": {"type": "history", "on": {"E": "x"}}}},
         "`on` of a history state has no counterpart in Lumen"),
        ({"invoke": {"src": "x", "input": {"n": 1}}}, "`input` of the `invoke` is left out"),
        ({"meta": {"lumen": {"resume": "soon"}}}, "`resume` of `meta.lumen` has no counterpart in Lumen"),
        ({"description": ["x"]}, "`description` is not a string"),
        ({"invoke": {"src": "x", "id": 3}}, "`id` is not a string"),
        ({"invoke": [None]}, "this is not an invocation"),
        ({"invoke": {"src": {"type": "x", "pace": 3}}}, '`invoke` of `x {"pace": 3}`: its code is not in the file'),
        ({"type": "final", "output": 1, "data": 2}, "`data` beside `output` is left out"),
        ({"on": {" *": "b"}}, "the events ` *` are renamed to `*`"),
        ({"on": {"E": {"target": ["a", "b"]}}}, "`a` and `b` can't be active together"),
        ({"states": {"h": {"type": "history"}}, "on": {"E": ".h"}}, "there is no state `.h` to go to"),
        ({"initial": "h", "states": {"h": {"history": True}, "x": {}}},
         "this history leads to a history, the first state of its parent"),
        ({"initial": "x", "states": {"h": {"history": True}, "i": {"type": "history", "target": "h"}, "x": {}}},
         "a history can't lead to a history"),
    ],
)  # fmt: skip
def test_unread_keys_of_a_machine_are_listed(state: dict[str, Any], found: str) -> None:
    said = xstate({"initial": "a", "states": {"a": state, "b": {}}})[1]
    assert found in [d.message for d in said], messages(said)


def test_a_key_that_is_assigned_values_of_two_kinds_may_hold_both() -> None:
    entry = {"type": "xstate.assign", "assignment": {"n": "one"}}
    data, found = xstate({"context": {"n": 0}, "states": {"a": {"entry": entry}}})
    assert (data["types"], found) == ({"n": {}}, [])
    it = Interpreter(Machine.from_dict(data))
    assert it.start().snapshot.context == {"n": "one"}


def test_an_event_with_a_blank_has_one_name() -> None:
    data, found = xstate("event-with-blank.json")
    assert [d.message for d in found] == [
        "the event `menu shown` is renamed to `menu_shown` in the whole behaviour",
        "the event `say hello` is renamed to `say_hello` in the whole behaviour",
    ]
    it = Interpreter(Machine.from_dict(data))
    it.start()
    assert set(it.configuration) == {"b"}
    it.clock.advance(1.0)
    assert set(it.configuration) == {"c"}


def test_names_that_only_clash_after_cleaning_stay_two() -> None:
    chart = {"initial": "a", "states": {
        "a": {"invoke": [{"id": "my clock", "src": "x", "onDone": "b"}, {"id": "my_clock", "src": "y", "onDone": "c"}],
              "on": {"say it": "b", "say_it": "c"}, "entry": {"type": "xstate.raise", "event": "say it"}},
        "b": {"id": "x y"}, "c": {"id": "x_y"}}}  # fmt: skip
    data, _ = xstate(chart)
    assert data["states"]["a"]["on"] == {
        "say_it_2": "b", "say_it": "c", "done.invoke.my_clock_2": "b", "done.invoke.my_clock": "c",
    }  # fmt: skip
    assert data["states"]["a"]["entry"] == [{"raise": "say_it_2"}]
    assert [data["states"][key]["id"] for key in "bc"] == ["x_y_2", "x_y"]


def test_a_key_that_is_there_twice_is_listed() -> None:
    content = b'{"initial": "a", "states": {"a": {"on": {"E": "a", "E": "b"}}, "b": {}}}'
    _, found = read_xstate("chart.json", content, "chart")
    assert messages(found) == [
        "1:52 `E` is written twice in the same place (only the last one is used: delete the others)"
    ]


def changed_json(data: Any, where: tuple[Any, ...] = ()) -> Iterator[tuple[str, Any]]:
    """Yield the path of each key with data in which it is removed, renamed or has another value."""
    for key, value in data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ():
        path = ".".join(map(str, (*where, key)))
        others = {k: v for k, v in data.items() if k != key} if isinstance(data, dict) else None
        if others is not None:
            yield path, others
            yield path, {**others, f"{key}x": value}
        if isinstance(value, bool | int | str):
            new = (not value) if isinstance(value, bool) else value + 1 if isinstance(value, int) else f"{value}q"
            yield path, data | {key: new} if isinstance(data, dict) else [*data[:key], new, *data[key + 1 :]]
        for below, changed in changed_json(value, (*where, key)):
            yield below, data | {key: changed} if isinstance(data, dict) else [*data[:key], changed, *data[key + 1 :]]


@for_each(
    ("name", "meaningless"),
    [
        # explicit defaults, keys without meaning, and parts of something that is listed as lost
        ("rich4.json", {"id", "key", "predictableActionArguments", "initial", "states.b.initial",
                        "states.b.invoke.data.n", "states.b.invoke.autoForward", "states.b.states.was.type",
                        "states.b.states.was.target"}),
        ("rich5.json", {"states.a.tags.0", "states.a.on.say it.reenter", "states.b.initial", "states.b.invoke.input.n",
                        "states.z.meta.note"}),
    ],
)  # fmt: skip
def test_no_change_of_a_key_is_silent(name: str, meaningless: set[str]) -> None:
    def read(data: Any) -> Any:
        try:
            result, found = read_xstate(name, json.dumps(data).encode(), "chart")
        except ForeignFileError as error:
            return str(error.diagnostic)
        return json.dumps(result), sorted((d.message, d.hint) for d in found)

    machine = json.loads((INPUTS / name).read_bytes())
    before = read(machine)
    assert {path for path, changed in changed_json(machine) if read(changed) == before} == meaningless


SETTINGS = b"name: Charts\nbehavior: hello\nlanguages: [en]\nrobot: {name: NAO, model: nao}\n"


def lint(hello: str, **others: str) -> list[str]:
    """Return the findings of a small project with that behaviour and others by name."""
    files = {"lumen.yaml": SETTINGS, "behaviors/hello.yaml": hello.encode()}
    files |= {f"behaviors/{name}.yaml": text.encode() for name, text in others.items()}
    found = check_files(INPUTS, files)[1]
    return [f"{d.place.line}:{d.place.column} {d.code}: {d.message} ({d.hint})" for d in found]


def of(name: str) -> str:
    return (INPUTS / name).read_text("utf-8")


def test_a_star_above_the_end_is_found() -> None:
    assert lint(of("star-before-done.yaml")) == [
        "7:13 shadowed-transition: this transition is never taken: the one on line 5 is always taken first"
        " (write `onDone` above `on`, or name the events instead of `*`)"
    ]


@for_each(
    ("state", "found"),
    [
        ('{on: {"*": b}, do: {say: Hi}, onDone: c}', True),
        ('{do: {say: Hi}, onDone: c, on: {"*": b}}', False),
        ('{on: {done: b}, do: {say: Hi}, onDone: c}', True),
        ('{on: {error.*: b}, do: {say: Hi}, onDone: c}', False),
        ('{on: {error.*: b}, do: {say: Hi}, onDone: c, onError: c}', True),
        ('{on: {"*": b}, initial: x, states: {x: {type: final}}, onDone: c}', True),
        ('{on: {"*": b}, invoke: {behavior: quick, onDone: c}}', True),
        ('{on: {"*": {guard: "event.name != \'done.do.a\'", target: b}}, do: {say: Hi}, onDone: c}', False),
        ('{on: {"*": b}, do: {say: Hi}, after: {5s: c}}', False),  # a timer is selected by no name
        ('{on: {after.5s.a: b}, after: {5s: c}}', False),
        ('{initial: invoke, states: {invoke: {on: {"*": "#c"}, do: {say: H}, onDone: x}, x: {on: {e: "#c"}}}}', True),
    ],
)  # fmt: skip
def test_an_end_below_a_key_that_handles_it(state: str, found: bool) -> None:
    chart = f"initial: a\nstates:\n  a: {state}\n  b: {{after: {{5s: a}}}}\n  c: {{id: c, after: {{5s: a}}}}\n"
    codes = [line.split()[1] for line in lint(chart, quick=of("quick.yaml"))]
    assert ("shadowed-transition:" in codes) == found, codes


@for_each(
    ("name", "message"),
    [
        ("endless-guarded.yaml", "6:59 always-loop: this loop never ends while `context.balance > 300` is false"),
        ("endless-invoke.yaml", "4:44 endless-chain: this loop never ends: `done.invoke.quick` of `work`"),
    ],
)
def test_an_endless_chain_is_found(name: str, message: str) -> None:
    (found,) = lint(of(name), **({"quick": of("quick.yaml")} if "invoke" in name else {}))
    assert found.startswith(message)


INVOKED = {
    "quick": "initial: a\nstates: {a: {type: final}}\n",
    "slow": "initial: a\nstates: {a: {after: {1s: b}}, b: {type: final}}\n",
    "outer": "initial: a\nstates: {a: {invoke: {behavior: quick, onDone: b}}, b: {type: final}}\n",
    "two": "type: parallel\nstates: {a: {states: {x: {type: final}}}, b: {states: {x: {type: final}}}}\n",
}


def endless(states: str) -> list[str]:
    """Return lint's findings on endless chains of these states; `touched` enters `a`, and `c` is quiet."""
    chart = f"initial: c\ncontext: {{n: 0}}\nstates: {{c: {{on: {{touched: a}}}}, {states}}}\n"
    found = lint(chart, **{name: text for name, text in INVOKED.items() if name in states})
    assert not any("this loop never ends" in line for line in found) or not rests(chart), found
    return [line.partition(": ")[2] for line in found if "endless-chain" in line or "always-loop" in line]


def rests(chart: str) -> bool:
    """Return whether the engine comes to rest after the event; more than 100 instant steps are no rest."""
    data = {name: parse(name, text.encode())[0] for name, text in {"chart": chart, **INVOKED}.items()}
    read = {name: document.data for name, document in data.items() if document is not None}
    steps: list[Any] = []

    def observe(step: Any) -> None:
        steps.append(step)
        if len(steps) + len(step.transitions) > 100:
            raise LumenError("there is no rest")

    it = Interpreter(Machine.from_dict(read.pop("chart"), behaviors=read), observe=observe)
    try:
        it.start()
        for _ in range(2):
            it.send("touched")
            it.clock.advance(0.5)
    except LumenError:
        return False
    return True


@for_each(
    ("states", "way"),
    [
        ("a: {entry: {raise: go}, on: {go: b, touched: c}}, b: {entry: {raise: back}, on: {back: a}}",
         "`go` of `a`, `back` of `b`"),
        ("a: {do: {log: x}, onDone: b, on: {touched: c}}, b: {after: {0s: a}}",
         "`done.do.a` of `a`, `after: 0s` of `b`"),
        ("a: {after: {0s: b}}, b: {after: {0s: a}, on: {touched: c}}", "`after: 0s` of `a`, `after: 0s` of `b`"),
        ("a: {after: {0s: b}, do: {say: Hi}, onDone: c}, b: {always: a}", "`after: 0s` of `a`, `always` of `b`"),
        ("a: {do: {send: go}, on: {go: a, touched: c}}", "`go` of `a`"),
        ("a: {do: [{raise: go}, {say: Hi}], on: {go: a, touched: c}}", "`go` of `a`"),
        ("a: {do: {wait: 0s}, on: {done: a, touched: c}}", "`done.do.a` of `a`"),
        ("a: {exit: {raise: go}, entry: {raise: go}, on: {go: a, touched: c}}", "`go` of `a`"),
        ("a: {initial: x, states: {x: {type: final}}, onDone: a, on: {touched: c}}", "`done.state.a` of `a`"),
        ("a: {initial: x, states: {x: {do: {log: y}, onDone: y}, y: {type: final}}, onDone: a, on: {touched: c}}",
         "`done.state.a` of `a`, `done.do.a.x` of `a.x`"),
        ("a: {type: parallel, states: {p: {states: {x: {type: final}}}, q: {states: {x: {type: final}}}}, onDone: a}",
         "`done.state.a` of `a`"),
        ("a: {type: parallel, states: {p: {states: {x: {do: {log: y}, onDone: x}}}, q: {}}, on: {touched: c}}",
         "`done.do.a.p.x` of `a.p.x`"),
        ("a: {type: parallel, states: {p: {entry: {raise: go}}, q: {states: {x: {on: {go: '#b'}}}}}, on: {touched: c}},"
         " b: {id: b, always: a}", "`go` of `a.q.x`, `always` of `b`"),
        ("a: {on: {touched: {actions: {raise: again}}, again: {actions: {raise: again}}, face: c}}", "`again` of `a`"),
        ("a: {invoke: {behavior: quick, onDone: a}, on: {touched: c}}", "`done.invoke.quick` of `a`"),
        ("a: {invoke: {behavior: two, id: w, onDone: a}, on: {touched: c}}", "`done.invoke.w` of `a`"),
        ("a: {invoke: {behavior: quick}, on: {done.invoke.quick: b}}, b: {always: a}",
         "`done.invoke.quick` of `a`, `always` of `b`"),
        ("a: {do: {log: x}, onDone: [{guard: context.n < 4, target: a}, c]}", ""),
        ("a: {do: {log: x}, onDone: [{guard: context.n > 4, target: c}, a], entry: {assign: {n: context.n + 1}}}", ""),
        ("a: {do: {say: x}, onDone: b}, b: {do: {log: x}, onDone: a, on: {touched: c}}", ""),
        ("a: {entry: {raise: go}, on: {go: b}}, b: {on: {go: a, touched: c}}", ""),
        ("a: {entry: {send: {event: go, delay: 1s}}, on: {go: a, touched: c}}", ""),
        ("a: {after: {0s: {actions: {log: once}}}, on: {touched: c}}", ""),
        ("a: {invoke: {behavior: slow, onDone: a}, on: {touched: c}}", ""),
        ("a: {entry: {raise: go}, do: {log: x}, on: {go: b}}, b: {on: {done: a, touched: c}}", ""),
        ("a: {type: parallel, states: {p: {entry: {raise: go}}, q: {on: {go: .y}, initial: x, states: {x: {}, y: {}}}},"
         " on: {touched: c}}", ""),
        ("a: {entry: {raise: out}, initial: x, states: {x: {after: {0s: x}}}, on: {out: c}}", ""),  # left before that
        ("a: {do: {log: x}, onDone: c, on: {go: {actions: {raise: go}}}}", ""),  # left before a `go` comes
        ("a: {after: {0s: c}, initial: x, states: {x: {on: {touched: {}, y: {actions: {raise: y}}}}}}",
         ""),
        ("a: {initial: x, always: b, states: {x: {}}}, b: {initial: y, always: a, states: {y: {}}}",
         ""),  # `endless-always` reports it
    ],
)  # fmt: skip
def test_endless_chains_of_every_make(states: str, way: str) -> None:
    assert [f"never ends: {way} (" in line for line in endless(states)] == ([True] if way else [])


def test_an_always_of_states_with_states_within_is_endless_too() -> None:
    chart = "initial: a\nstates: {a: {always: b, states: {x: {}}}, b: {always: a, states: {y: {}}}}\n"
    assert [line.split()[1] for line in lint(chart) if "this loop never ends" in line] == ["endless-always:"]


def test_an_endless_chain_of_behaviours_within_behaviours_is_found() -> None:
    found = lint(
        "initial: a\nstates: {a: {invoke: {behavior: outer, onDone: a}, on: {touched: b}}, b: {after: {5s: a}}}\n",
        **INVOKED,
    )
    assert any("never ends: `done.invoke.outer` of `a`" in line for line in found)


@for_each(
    ("states", "way"),
    [
        ("a: {always: [{guard: context.n > 3, target: c}, b]}, b: {always: a}",
         "while `context.n > 3` is false: `always` of `a`, `always` of `b`"),
        ("a: {always: [{guard: context.n > 3, target: c}, {guard: context.n <= 3, target: b}]}, b: {always: a}",
         "while `context.n <= 3`: `a` → `b` → `a`"),
        ("a: {entry: {raise: go}, always: {guard: context.n > 3, target: c}, on: {go: a}}",
         "while `context.n > 3` is false: `go` of `a`"),
        ("a: {always: [{guard: context.n > 3, target: c}, {guard: context.n > 2, target: c}, {actions: {raise: go}}]}",
         "while `context.n > 3` and `context.n > 2` are false: `always` of `a`"),
        ("a: {always: [{guard: context.n > 3, target: c}, b]}, b: {exit: {assign: {n: context.n + 1}}, always: a}", ""),
        ("a: {entry: {raise: go}, always: {guard: context.n > 3, target: c}, on: {go: {target: a,"
         " actions: {assign: {n: context.n + 1}}}}}", ""),
        ("a: {always: [{guard: context.n > 3, target: c}, b]}, b: {after: {1s: a}}", ""),
    ],
)  # fmt: skip
def test_endless_chains_while_a_guard_stays_false(states: str, way: str) -> None:
    assert [f"never ends {way} (" in line for line in endless(states)] == ([True] if way else [])


def test_the_error_of_an_endless_chain_names_its_transitions() -> None:
    quick = {"initial": "a", "states": {"a": {"type": "final"}}}
    for name, way in (
        ("endless-invoke.yaml", "the loop is: `done.invoke.quick` of `work`"),
        ("endless-guarded.yaml", "the loop is: `always` of `two`"),
    ):
        document, _ = parse(name, of(name).encode())
        assert document is not None
        it = Interpreter(Machine.from_dict(document.data, behaviors={"quick": quick}))
        it.start()
        with pytest.raises(LumenError, match=re.escape(way)):
            it.send("touched")


def test_a_target_in_another_region_is_found() -> None:
    (found,) = lint(of("other-region.yaml"))
    message = "`demo` is in another region, so all of `hello` is left and restarted"
    assert found.startswith(f"6:103 crosses-regions: {message} (")
    assert "an event that the region of `demo` waits for" in found


@for_each(
    ("way", "found"),
    [
        ('l: {initial: a, states: {a: {on: {touched: b}}, b: {after: {5s: a}}}}', False),
        ('l: {initial: a, states: {a: {on: {touched: {target: ["#b", "#r2"]}}}, b: {id: b, after: {5s: a}}}}', False),
        ('l: {initial: a, states: {a: {on: {touched: "#r2"}}}}', True),
        ('l: {initial: a, on: {touched: "#r2"}, states: {a: {}}}', True),
    ],
)  # fmt: skip
def test_which_targets_leave_other_regions(way: str, found: bool) -> None:
    right = "r: {initial: r1, states: {r1: {after: {5s: r2}}, r2: {id: r2, after: {5s: r1}}}}"
    codes = [line.split()[1] for line in lint(f"type: parallel\nstates:\n  {way}\n  {right}\n")]
    assert ("crosses-regions:" in codes) == found, codes


def test_reenter_without_a_target_is_found() -> None:
    assert lint(of("reenter-nothing.yaml")) == [
        "7:21 no-effect: `reenter` has no effect without a `target`: the state is not left"
        " (write `target: .` to restart `speak`, or delete `reenter`)"
    ]


@for_each(
    ("state", "found"),
    [
        ("{always: b, do: {say: Hi}, after: {5s: b}}",
         "3:18 no-effect: `do`, `after` have no effect: `always` leaves `a` at once"
         " (give the `always` a `guard`, or delete it)"),
        ("{always: [{guard: context.n > 1, target: a}, b], on: {touched: b}}",
         "3:55 no-effect: `on` has no effect: `always` leaves `a` at once (give the `always` a `guard`, or delete it)"),
        ("{always: {guard: context.n > 1, target: b}, on: {touched: b}}", ""),
        ("{always: b, entry: {log: x}, exit: {log: x}}", ""),
        ("{always: b, initial: x, states: {x: {on: {touched: b}}}, on: {touched: b}}", ""),
    ],
)  # fmt: skip
def test_keys_beside_an_instant_always_are_found(state: str, found: str) -> None:
    lines = lint(f"context: {{n: 0}}\nstates:\n  a: {state}\n  b: {{after: {{5s: a}}}}\n")
    assert [line for line in lines if "no-effect" in line] == ([found] if found else [])


@for_each(
    ("within", "found"),
    [
        ('x: {on: {"*": y}}, y: {on: {"*": x}}', True),
        ('x: {on: {"*": y}}, y: {on: {touched: x}}', False),
        ('x: {on: {done: y}}, y: {initial: z, on: {done.invoke: x}, states: {z: {}}}', True),
        ('x: {on: {"*": {guard: "event.name != \'e\'", target: y}}}, y: {on: {"*": x}}', False),
        ('x: {on: {touched: y}}, y: {type: final}', False),
    ],
)  # fmt: skip
def test_the_end_of_an_invocation_that_inner_states_handle(within: str, found: bool) -> None:
    chart = (
        f"initial: a\nstates:\n  a: {{invoke: {{behavior: quick, onDone: b}}, initial: x, states: {{{within}}}}}\n"
        "  b: {after: {5s: a}}\n"
    )
    lines = [line for line in lint(chart, quick=of("quick.yaml")) if "shadowed-transition" in line]
    assert [line.partition(" ")[0] for line in lines] == (["3:41"] if found else [])


def test_no_unlike_event_is_proposed() -> None:
    found = lint(of("event-hint.yaml"))
    assert len(found) == 6
    hint = "(declare it under `events:`, or write it as the `event` of a route in lumen.yaml)"
    assert all(line.endswith(hint) for line in found)


@for_each(
    ("word", "names", "meant"),
    [
        ("deactivate", ["done.state"], ""), ("delete", ["left"], ""), ("greating", ["greeting"], "greeting"),
        ("waveing", ["wave"], "wave"), ("tuoched", ["touched"], "touched"), ("visitor_left", ["left"], "left"),
    ],
)  # fmt: skip
def test_a_hint_is_a_name_with_few_letters_changed(word: str, names: list[str], meant: str) -> None:
    assert nearest(word, names) == meant
