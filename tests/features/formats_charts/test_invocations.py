"""`invoke` in other tools' files: a chart or an actor by name, out and in again; and in diagrams."""

import json
from typing import Any

import pytest

from lumen.features.formats_charts.dot import dot
from lumen.features.formats_charts.mermaid import mermaid
from lumen.features.formats_charts.scxml import read_scxml, write_scxml
from lumen.features.formats_charts.xstate import read_xstate, write_xstate
from lumen.language.diagnostics import has_errors
from lumen.project.formats.conversion_findings import ForeignFileError, dotted
from lumen.project.formats.yaml_document import document_yaml
from lumen.statechart import Interpreter, Machine
from tests.tables import for_each

QUIZ: dict[str, Any] = {
    "context": {"round": 0, "who": ""},
    "initial": "ask",
    "states": {"ask": {"on": {"right": "over"}}, "over": {"type": "final", "output": "context.round"}},
}
HOST: dict[str, Any] = {
    "id": "host",
    "context": {"n": 2},
    "initial": "one",
    "states": {
        "one": {
            "invoke": [
                {"behavior": "quiz", "onDone": {"guard": "event.data > 2", "target": "two"}, "onError": "two"},
                {"behavior": "quiz", "id": "again", "input": {"round": "context.n + 1", "who": "'Ani'"}},
            ],
        },
        "two": {"initial": "a", "states": {"a": {"on": {"go": "b"}}, "b": {}}, "invoke": {"behavior": "quiz"}},
    },
}


@pytest.fixture
def host() -> Machine:
    return Machine.from_dict(HOST, behaviors={"quiz": QUIZ})


def test_scxml_names_the_file(host: Machine) -> None:
    text, said = write_scxml(host, dotted("host"))
    assert '<invoke type="http://www.w3.org/TR/scxml/" id="again" src="quiz.scxml" autoforward="true">' in text
    assert '<param name="round" expr="n + 1"/>' in text
    assert {d.message for d in said} == {"`invoke` of `quiz` needs the file `quiz.scxml`"}
    assert not has_errors(said)
    once, found = read_scxml("host.scxml", text.encode(), "host")
    assert not has_errors(found)
    assert once["states"]["one"]["invoke"] == [
        {"behavior": "quiz"},
        {"behavior": "quiz", "id": "again", "input": {"round": "context.n + 1", "who": "'Ani'"}},
    ]
    assert once["states"]["one"]["on"]["done.invoke.quiz"] == {"guard": "event.data > 2", "target": "two"}
    again, _ = write_scxml(Machine.from_dict(once, behaviors={"quiz": QUIZ}), dotted("host"))
    assert again == text


def test_an_invoke_whose_input_scxml_can_not_express_is_left_out() -> None:
    invoke = {"behavior": "quiz", "input": {"who": "context"}}
    host = Machine.from_dict({"states": {"one": {"invoke": invoke}}}, behaviors={"quiz": QUIZ})
    text, said = write_scxml(host, dotted("host"))
    assert "<invoke" not in text
    assert [d.message for d in said] == [
        "`invoke` of `quiz` is left out: `context` as a whole has no counterpart in ECMAScript"
    ]


def test_xstate_names_the_actor(host: Machine) -> None:
    text, said = write_xstate(host, dotted("host"))
    rows = json.loads(text)["states"]["one"]["invoke"]
    assert [(row["id"], row["src"]) for row in rows] == [("quiz", "quiz"), ("again", "quiz")]
    assert rows[0]["onError"] == [{"target": "two"}]
    assert not has_errors(said)
    once, found = read_xstate("host.json", text.encode(), "host")
    assert not found
    assert once["states"]["one"]["invoke"] == HOST["states"]["one"]["invoke"]
    assert write_xstate(Machine.from_dict(once, behaviors={"quiz": QUIZ}), dotted("host"))[0] == text


@for_each(
    ("invoke", "row"),
    [
        ('src="quiz.scxml"', {"behavior": "quiz"}),
        ('src="file:charts/quiz.txml.scxml" id="q.1"', None),
        ('type="scxml" src="../quiz.scxml" id="q.1"', {"behavior": "quiz", "id": "q.1"}),
        ('src="quiz.scxml" namelist="n"', {"behavior": "quiz", "input": {"n": "context.n"}}),
        ('srcexpr="n"', None),
        ('src="my quiz.scxml"', None),
        ('src="quiz.scxml" idlocation="n"', None),
        ('type="x-audio" src="quiz.scxml"', None),
        ('src="quiz.scxml" id="a b"', None),
    ],
)
def test_what_scxml_invokes(invoke: str, row: dict[str, Any] | None) -> None:
    text = (
        '<scxml xmlns="http://www.w3.org/2005/07/scxml"><datamodel><data id="n" expr="1"/></datamodel>'
        f'<state id="a"><invoke {invoke}/></state></scxml>'
    )
    data, said = read_scxml("a.scxml", text.encode(), "a")
    assert data["states"]["a"].get("invoke") == row
    assert has_errors(said) is (row is None)
    assert len(said) == 1


def test_what_waits_for_the_end_of_a_lost_invoke_stays() -> None:
    text = (
        '<scxml xmlns="http://www.w3.org/2005/07/scxml"><state id="a"><invoke id="i.1" srcexpr="n"/>'
        '<transition event="done.invoke.i.1" target="b"/><transition event="error.platform" target="a"/></state>'
        '<parallel id="b"><final id="f"/><state id="r"><final id="z"/></state>'
        '<transition event="done.state.b" target="c"/></parallel><final id="c"/></scxml>'
    )
    data, said = read_scxml("a.scxml", text.encode(), "a")
    assert data["states"]["a"]["on"] == {"done.invoke.i.1": "b", "error.platform": "a"}
    assert [d.hint for d in said if d.severity == "error"] == [
        "invoke a behaviour with the id `i.1`: transitions on `done.invoke.i.1` are kept"
    ]
    it = Interpreter(Machine.from_dict(data))
    it.start()
    it.send("done.invoke.i.1")
    assert "c" in it.configuration


def test_diagrams_show_what_is_inside_once(host: Machine) -> None:
    lines = [line.strip() for line in mermaid(host).splitlines()]
    start = lines.index('state "one" as s1 {')
    assert lines[start + 1 : start + 4] == [
        'state "quiz" as s1i0 {',
        'state "ask" as s1i0s1',
        'state "over" as s1i0s2',
    ]
    assert 'state "again#58; quiz" as s1i1' in lines
    assert lines.index("s3 --> s4 : go") < lines.index('state "quiz" as s2i0') - 1  # in the region of its states
    assert sum('"ask"' in line for line in lines) == 1
    drawn = dot(host)
    assert 'label="quiz"; style=dashed' in drawn
    assert drawn.count('[label="ask"]') == 1


def test_a_machine_taken_apart_says_what_to_write_instead() -> None:
    data = {"id": "m", "key": "m", "order": -1, "transitions": [], "states": {"a": {"order": 1}}}
    with pytest.raises(ForeignFileError, match="not a machine's configuration"):
        read_xstate("m.json", json.dumps(data).encode(), "m")


def test_what_json_lost_of_xstate_is_listed() -> None:
    data = {"states": {"a": {"entry": [None, "hi"], "on": {"x": {"meta": {"y": 1}}}}}, "output": {"z": 1}}
    found, said = read_xstate("m.json", json.dumps(data).encode(), "m")
    assert {d.message for d in said} == {
        "a machine can't have `output`",
        "an action is null: JSON can't contain its code",
        "the code of the action `hi` is not in the file",
        "`meta` is not carried over",
    }
    assert "hi" in document_yaml(found)
