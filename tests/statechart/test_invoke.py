"""Behaviours within behaviours: their origin, their reports, and their snapshots."""

import json
from pathlib import Path
from typing import Any

import pytest

from lumen.clock.virtual import VirtualClock
from lumen.errors import ProjectError, SnapshotError, UsageError
from lumen.statechart import Event, Interpreter, Machine, deserialize, due, initial, serialize, step

QUIZ: dict[str, Any] = {
    "context": {"asked": 0},
    "states": {
        "ask": {"do": [{"say": "Well?"}, {"wait": "2s"}], "onDone": "end", "after": {"9s": "end"}},
        "end": {"type": "final", "output": {"asked": "context.asked"}},
    },
}
TOUR: dict[str, Any] = {
    "id": "tour",
    "context": {"asked": 3},
    "states": {
        "a": {
            "invoke": {"behavior": "quiz", "input": {"asked": "context.asked"}, "onDone": "b"},
            "on": {"go": "b"},
            "after": {"7s": "b"},
        },
        "b": None,
    },
}


def tour(quiz: dict[str, Any] = QUIZ, **changes: Any) -> Machine:
    return Machine.from_dict({**TOUR, **changes}, behaviors={"quiz": quiz})


def faults(data: dict[str, Any], behaviors: dict[str, Any]) -> list[tuple[str, str]]:
    with pytest.raises(ProjectError) as caught:
        Machine.from_dict(data, behaviors=behaviors)
    return [(d.code, d.place.file) for d in caught.value.diagnostics]


def test_the_steps_of_what_is_invoked_are_told() -> None:
    first = initial(tour())
    [(id, inner)] = first.invoked
    assert (id, inner.entered, inner.snapshot.context) == ("quiz", ("ask",), {"asked": 3})
    last = step(tour(), first.snapshot, Event("go"))
    [(_, ended)] = last.invoked
    assert (ended.exited, last.snapshot.invoked) == (("ask",), {})


def test_the_first_timer_of_all_is_due() -> None:
    snapshot = initial(tour()).snapshot
    assert due(snapshot) == Event("after.7s.a", None, 7.0, "after.7s.a")
    snapshot = step(tour(), snapshot, Event("done.command.d1@quiz", at=1.0)).snapshot
    assert due(snapshot) == Event("wait.w1", None, 3.0, "w1@quiz")
    assert step(tour(), snapshot, due(snapshot) or Event("")).entered == ("b",)


def test_a_snapshot_through_the_disk_goes_on_as_before() -> None:
    it = Interpreter(tour())
    it.start()
    it.send("done.command.d1@quiz")
    again = Interpreter.restore(tour(), json.loads(json.dumps(it.snapshot())))
    assert again.snapshot() == it.snapshot()
    for each in (it, again):
        each.clock.wait(2.0)
        assert each.configuration == frozenset({"b"})
    assert again.snapshot() == it.snapshot()


@pytest.mark.parametrize(("timers", "ends"), [("deadline", 100.0), ("remaining", 101.5), ("restart", 102.0)])
def test_timers_of_what_is_invoked_after_a_restore(timers: Any, ends: float) -> None:
    it = Interpreter(tour())
    it.start()
    it.send("done.command.d1@quiz")
    it.clock.wait(0.5)
    it.send("nothing")
    again = Interpreter.restore(tour(), it.snapshot(), VirtualClock(100.0), timers)
    if ends > 100.0:
        again.clock.wait(ends - 0.01)
        assert again.configuration == frozenset({"a"})
    again.clock.wait(ends)
    assert again.configuration == frozenset({"b"})


def test_a_snapshot_with_another_machine_inside_is_refused() -> None:
    frozen = serialize(tour(), initial(tour()).snapshot)
    other = {**QUIZ, "states": {**QUIZ["states"], "more": None}}
    with pytest.raises(SnapshotError, match=r"`quiz`.*state `more` is new"):
        deserialize(tour(other), frozen)
    for damage in ({"x": frozen["invoked"]["quiz"]}, {"quiz": {"state": "b"}}, {"quiz": 3}, None):
        with pytest.raises(SnapshotError):
            deserialize(tour(), {**frozen, "invoked": damage})


def test_invoked_files_stand_beside_the_file(tmp_path: Path) -> None:
    (tmp_path / "tour.yaml").write_text("states: {a: {invoke: {behavior: quiz, onDone: b}}, b: }")
    (tmp_path / "quiz.yaml").write_text("states: {ask: {on: {right: end}}, end: {type: final}}")
    (tmp_path / "broken.yaml").write_text("states: 3")
    machine = Machine.load(tmp_path / "tour.yaml")
    assert isinstance(machine.invoked["quiz"], Machine)
    it = Interpreter(machine)
    it.start()
    it.send("right")
    assert it.configuration == frozenset({"b"})


def test_faults_of_invoked_files_are_told_in_their_files(tmp_path: Path) -> None:
    (tmp_path / "tour.yaml").write_text("states: {a: {invoke: [{behavior: quiz}, {behavior: quizz}, {behavior: x}]}}")
    (tmp_path / "quiz.yaml").write_text("states: {ask: {on: {right: edn}}, end: {type: final}}")
    (tmp_path / "x.yaml").mkdir()
    with pytest.raises(UsageError, match="can't read"):
        Machine.load(tmp_path / "tour.yaml")
    (tmp_path / "x.yaml").rmdir()
    with pytest.raises(ProjectError) as caught:
        Machine.load(tmp_path / "tour.yaml")
    found = {(d.code, Path(d.place.file).name, d.hint.partition("?")[0]) for d in caught.value.diagnostics}
    assert ("unknown-state", "quiz.yaml", "did you mean `end`") in found
    assert ("unknown-behavior", "tour.yaml", "did you mean `quiz`") in found
    assert len(found) == 3


def test_a_cycle_is_told_where_it_closes() -> None:
    def invoking(name: str) -> dict[str, Any]:
        return {"states": {"a": {"invoke": {"behavior": name}}}}

    ring = {"one": invoking("two"), "two": invoking("three"), "three": invoking("one")}
    assert faults(invoking("one"), ring) == [("invoke-cycle", "three (states.a.invoke.behavior)")]
    chain = {f"n{i}": invoking(f"n{i + 1}") for i in range(500)} | {"n500": {"states": {"a": None}}}
    assert {code for code, _ in faults(invoking("n0"), chain)} == {"too-large"}
    assert {code for code, _ in faults(invoking("n0"), dict(reversed(chain.items())))} == {"too-large"}


def test_input_has_to_fit() -> None:
    wrong = {"behavior": "quiz", "input": {"askd": 1, "asked": [1]}}
    states = {"a": {"invoke": wrong}, "b": {"invoke": {"behavior": "quiz", "input": {"asked": "'x'"}}}}
    assert faults({"states": states}, {"quiz": QUIZ}) == [
        ("unknown-context-key", "machine (states.a.invoke.input.askd)"),
        ("type-mismatch", "machine (states.a.invoke.input.asked)"),
    ]


def test_the_same_behaviour_may_run_twice_under_two_ids() -> None:
    rows = [{"behavior": "quiz", "id": "one"}, {"behavior": "quiz", "id": "two", "onDone": "b"}]
    machine = tour(states={**TOUR["states"], "a": {"invoke": rows}})
    it = Interpreter(machine)
    it.start()
    it.send("done.command.d2@two")
    it.clock.wait(2.0)
    assert it.configuration == frozenset({"b"})
    both = {"states": {"a": {"invoke": [{"behavior": "quiz"}, {"behavior": "quiz"}]}}}
    assert faults(both, {"quiz": QUIZ}) == [("duplicate-id", "machine (states.a.invoke.1.behavior)")]
