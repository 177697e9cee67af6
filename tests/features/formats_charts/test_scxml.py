"""The import of each part of SCXML, and the reports for parts that Lumen does not support."""

from typing import Any
from xml.sax.saxutils import escape

from lumen.features.formats_charts.scxml import read_scxml, write_scxml
from lumen.project.formats.conversion_findings import dotted
from lumen.statechart import Machine
from tests.tables import for_each

HEAD = '<scxml xmlns="http://www.w3.org/2005/07/scxml" datamodel="ecmascript" name="chart">\n'


def read(body: str) -> tuple[dict[str, Any], list[str]]:
    """Return the data, and the line and message of each finding."""
    data, diagnostics = read_scxml("chart.scxml", (HEAD + body + "</scxml>").encode(), "chart")
    Machine.from_dict(data)
    return data, [f"{d.place.line}: {d.message}" for d in diagnostics]


def state(content: str, more: str = "") -> dict[str, Any]:
    """Import a state with this content and return its data; the import must report nothing."""
    data, said = read(f'<datamodel><data id="x" expr="0"/></datamodel><state id="a">{content}</state>{more}')
    assert said == []
    found: dict[str, Any] = data["states"]["a"]
    return found


B = '<state id="b"><state id="c"/></state>'


@for_each(
    ("content", "expected"),
    [
        ('<transition event="e" target="b"/>', {"on": {"e": "b"}}),
        ('<transition event="e f.* g." target="c"/>', {"on": {"e": "#c", "f": "#c", "g": "#c"}}),
        ('<transition event="*"/>', {"on": {"*": {}}}),
        ('<transition cond="x &gt; 1" target="b"/>', {"always": {"guard": "context.x > 1", "target": "b"}}),
        (
            '<transition event="e" cond="In(\'b\')"><raise event="f"/></transition>',
            {"on": {"e": {"guard": "In('b')", "actions": [{"raise": "f"}]}}},
        ),
        ('<onentry><send event="e" delay="1500ms" id="i"/></onentry>',
         {"entry": [{"send": {"event": "e", "delay": "1.5s", "id": "i"}}]}),
        ('<onentry><send event="e" delayexpr="\'2s\'"><param name="p" expr="x + 1"/></send></onentry>',
         {"entry": [{"send": {"event": "e", "data": {"p": "context.x + 1"}, "delay": "2s"}}]}),
        ('<onexit><send event="e" target="#_parent" delay="2s"/><send event="e" targetexpr="\'#_q.a\'"/></onexit>',
         {"exit": [{"send": {"event": "e", "to": "parent", "delay": "2s"}}, {"send": {"event": "e", "to": "q.a"}}]}),
        ('<onexit><send target="#_internal" event="e"><content>{"a": "b"}</content></send></onexit>',
         {"exit": [{"raise": {"event": "e", "data": {"a": "'b'"}}}]}),
        ('<onexit><cancel sendid="i"/><log label="L" expr="\'n: \' + x"/></onexit>',
         {"exit": [{"cancel": "i"}, {"log": "L: n: {{ context.x }}"}]}),
        ('<onentry><script>x += 2; x++;</script></onentry>',
         {"entry": [{"assign": {"x": "context.x + 2"}}, {"assign": {"x": "context.x + 1"}}]}),
        (
            '<onentry><if cond="x"><raise event="a"/><elseif cond="x==1"/><else/><raise event="b"/></if></onentry>',
            {"entry": [{"if": "context.x != 0", "then": [{"raise": "a"}],
                        "else": [{"if": "context.x == 1", "then": [], "else": [{"raise": "b"}]}]}]},
        ),
    ],
)  # fmt: skip
def test_what_becomes_of_a_state(content: str, expected: dict[str, Any]) -> None:
    assert state(content, B) == expected


def test_document_order_survives_the_map_of_descriptors() -> None:
    rows = '<transition event="*" cond="x == 1" target="b"/><transition event="e.f" target="c"/><transition event="*"/>'
    assert state(rows, B)["on"] == {
        "*": [
            {"guard": "context.x == 1", "target": "b"},
            {"guard": "event.name == 'e.f' || matches(event.name, '^e\\\\.f\\\\.')", "target": "#c"},
            {},
        ]
    }


def test_external_is_told_from_internal() -> None:
    rows = '<transition event="e" target="c"/><transition event="i" type="internal" target="c"/>'
    found, said = read(f'<state id="b">{rows}<state id="c"/></state>')
    assert found["states"]["b"]["on"] == {"e": {"target": ".c", "reenter": True}, "i": ".c"}
    assert said == []


def test_parallel_history_final_and_deep_initial() -> None:
    data, said = read(
        '<parallel id="p"><history id="h" type="deep"><transition target="r2"/></history>'
        '<state id="r" initial="r2"><state id="r1"><state id="r2"/></state></state>'
        '<state id="s"><final id="f"><donedata><param name="n" expr="1"/></donedata></final></state></parallel>'
    )
    parallel = data["states"]["p"]
    assert parallel["type"] == "parallel"
    assert parallel["states"]["h"] == {"id": "h", "type": "history", "history": "deep", "target": "#r2"}
    assert parallel["states"]["r"]["initial"] == "#r2"
    assert parallel["states"]["s"]["states"]["f"] == {"id": "f", "type": "final", "output": {"n": 1}}
    assert said == []


def test_what_an_editor_has_in_its_own_element_may_be_an_action_elsewhere() -> None:
    box = '<e:box xmlns:e="urn:e"><e:turn/></e:box>'
    _, said = read(f'<state id="a">{box}<onentry>\n<e:turn xmlns:e="urn:e"/></onentry></state>')
    assert said == ["2: `<box>` of the namespace `urn:e` is ignored", "3: `<turn>` has no counterpart in Lumen"]


def test_a_final_state_of_a_parallel_one_is_written_as_a_state_that_is_at_its_end() -> None:
    regions = {"r": {"states": {"f": {"type": "final"}}}, "s": {"type": "final", "entry": {"log": "x"}}}
    text, said = write_scxml(Machine.from_dict({"states": {"p": {"type": "parallel", "states": regions}}}), dotted("m"))
    assert [d.message for d in said] == [
        "`p.s` is a final state in a parallel state: it becomes a state with an inner final state"
    ]
    data, _ = read_scxml("m.scxml", text.encode(), "m")
    found = data["states"]["p"]["states"]["s"]
    assert found == {"initial": "_end", "entry": [{"log": "x"}], "states": {"_end": {"type": "final"}}}


def test_values_that_change_their_kind_are_of_any() -> None:
    data, _ = read(
        '<datamodel><data id="x" expr="0"/><data id="y" expr="x + 1"/>'
        '<data id="z">[1, "a"]</data></datamodel>'
        '<state id="a"><onentry><assign location="x" expr="\'t\'"/></onentry></state>'
    )
    assert data["context"] == {"x": 0, "y": None, "z": [1, "a"]}
    assert data["types"] == {"x": {}}
    assert data["entry"] == [{"assign": {"y": "context.x + 1"}}]


@for_each(
    ("body", "said"),
    [
        ("<state>\n<invoke type='http'/></state>", ["3: `<invoke>`: the service `http` is not carried over"]),
        ("<state>\n<invoke/></state>",
         ["3: `<invoke>`: a computed or inline chart is not carried over"]),
        ("<state><onentry>\n<foreach array='x' item='y'/></onentry></state>",
         ["3: `<foreach>`: Lumen has no loops in actions"]),
        ("<state id='a'/>\n<state id='a'/>", ["3: a second state has the id `a`"]),
        ("<state>\n<transition event='e' target='z'/></state>", ["3: there is no state `z` to go to"]),
        ("<state>\n<transition event='e' cond='y = 1'/></state>",
         ["3: the condition `y = 1` can't be converted: Lumen's expressions have no assignments"]),
        ("<state><onentry>\n<send event='e' target='http://x'/></onentry></state>",
         ["3: `<send>` to `http://x` is left out"]),
        ("<state>\n<transition/></state>",
         ["3: a transition without event, condition and target is left out: it would repeat without end"]),
        ("<state>\n<custom xmlns='urn:x'/></state>", ["3: `<custom>` of the namespace `urn:x` is ignored"]),
    ],
)  # fmt: skip
def test_nothing_is_dropped_in_silence(body: str, said: list[str]) -> None:
    assert read(body)[1] == said


LISTS = '<datamodel><data id="l" expr="[3]"/><data id="t" expr="\'a\'"/><data id="n"/></datamodel>'


@for_each(
    ("expression", "value"),
    [
        ("l.concat()", "context.l"),
        ("l.concat([1])", "context.l + [1]"),
        ("l.concat([1], l)", "context.l + [1] + context.l"),
        ("l.concat([])", "context.l"),
        ("[].concat(l)", "context.l"),
        ("[].concat([])", "[]"),
        ("l.concat(n)", "context.l + context.n"),
        ("l.concat(2)", None),
        ("l.concat(t)", None),
        ("t.concat([1])", None),
    ],
)
def test_lists_are_concatenated_and_nothing_else_is(expression: str, value: str | None) -> None:
    data, said = read(f'{LISTS}<state id="a"><onentry>\n<assign location="n" expr="{expression}"/></onentry></state>')
    assert data["states"]["a"] == ({} if value is None else {"entry": [{"assign": {"n": value}}]})
    assert said == ([] if value else ["3: `<assign>`: `.concat()` is called on a value that is not a list"])


@for_each(
    ("expression", "value"),
    [
        ("x || 5", "context.x != 0 ? context.x : 5"),
        ("x && 5", "context.x != 0 ? 5 : context.x"),
        ("x || t || 5", "context.x != 0 ? context.x : context.t != '' ? context.t : 5"),
        ("x > 1 || t == 'a'", "context.x > 1 || context.t == 'a'"),
    ],
)
def test_the_value_of_or_and_and_is_that_of_an_operand(expression: str, value: str) -> None:
    data = '<datamodel><data id="x" expr="0"/><data id="t" expr="\'a\'"/><data id="n"/></datamodel>'
    written = f'<assign location="n" expr="{escape(expression)}"/>'
    found, said = read(f'{data}<state id="a"><onentry>{written}</onentry></state>')
    assert found["states"]["a"] == {"entry": [{"assign": {"n": value}}]}
    assert said == []


def test_assignments_to_a_part() -> None:
    data, said = read(
        '<datamodel><data id="v" expr="{}"/></datamodel><state id="a"><onentry>'
        '<assign location="v.at.room" expr="2"/>\n<assign location="w.at" expr="2"/>\n'
        '<assign location="v[0]" expr="2"/></onentry></state>'
    )
    assert data["states"]["a"]["entry"] == [{"assign": {"v.at.room": 2}}]
    assert said == [
        "3: `<assign>` to `w.at`, which is not declared",
        "4: `<assign>` to `v[0]`, which is not a plain name",
    ]


def test_assignments_to_a_part_are_written() -> None:
    chart = {
        "id": "chart",
        "context": {"v": {"at": {}}, "w": {}},
        "initial": "a",
        "states": {"a": {"entry": [{"assign": {"v.at.room": 2}}, {"assign": {"w.x": "context.v.at"}}]}},
    }
    text, said = write_scxml(Machine.from_dict(chart), dotted("chart"))
    assert said == []
    assert read_scxml("chart.scxml", text.encode(), "chart") == (chart, [])
    chart["states"] = {"a": {"entry": {"assign": {"v.living-room": 2}}}}
    assert 'location="v[&quot;living-room&quot;]"' in write_scxml(Machine.from_dict(chart), dotted("chart"))[0]


def test_what_only_lumen_has_comes_back() -> None:
    chart = {
        "id": "tour",
        "context": {"name": ""},
        "phrases": {"hi": {"en": ["hi", "hello"]}},
        "initial": "a",
        "states": {
            "a": {
                "do": [{"say": {"en": "Hello {{ context.name }}"}}, {"wait": "2s"}],
                "onDone": {"guard": "heard(event.data, 'hi')", "target": "b"},
                "after": {"2min": "b"},
            },
            "b": {"onReload": "a", "entry": [{"posture": {"name": "Stand", "speed": 0.5}}]},
        },
    }
    text, said = write_scxml(Machine.from_dict(chart), dotted("tour"))
    assert {d.message for d in said} == {
        f"only Lumen understands {what}"
        for what in ("`phrases`", "`do`", "`heard` in an expression", "`onReload`", "`posture`")
    }
    assert read_scxml("tour.scxml", text.encode(), "x") == (chart, [])
