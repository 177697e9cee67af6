"""The shell around `step`: the clock, snapshots on the disk, and refused calls."""

import json
from typing import Any

import pytest

from lumen.clock.virtual import VirtualClock
from lumen.errors import LumenError, ProjectError, SnapshotError, UsageError
from lumen.statechart import Event, Interpreter, Machine, Step, due, initial, step
from lumen.statechart.stepping import elapse
from lumen.statechart.values import MAX_TIMERS
from tests.tables import for_each

COUNTING = {"assign": {"n": "context.n + 1"}}
TOUR = {
    "id": "tour",
    "context": {"visits": 0, "visitor": None},
    "states": {
        "idle": {"id": "rest", "exit": {"assign": {"visits": "context.visits + 1"}}, "on": {"face": "greet"}},
        "greet": {
            "do": [{"say": {"any": ["Hello", "Hi", "Good day"]}}, {"wait": "2s"}, {"play": "wave"}],
            "onDone": "idle",
            "after": {"20s": "idle"},
        },
    },
}


def running(**options: Any) -> Interpreter:
    it = Interpreter(Machine.from_dict(TOUR), **options)
    it.start()
    it.send("face")
    return it


def test_what_the_interpreter_tells() -> None:
    it = running()
    assert it.configuration == frozenset({"greet"})
    assert it.context == {"visits": 1, "visitor": None}
    it.send(Event("done.command.d1"))
    it.clock.wait(2.0)
    it.send("done.command.d2")
    assert it.configuration == frozenset({"rest"})


def test_advance_stops_at_every_due_time() -> None:
    steps: list[Step] = []
    ticking = {"states": {"a": {"after": {"500ms": "b"}}, "b": {"after": {"1s": "a"}}}}
    it = Interpreter(Machine.from_dict(ticking), observe=steps.append)
    it.start()
    it.clock.wait(4.2)
    assert [step.snapshot.at for step in steps] == [0.0, 0.5, 1.5, 2.0, 3.0, 3.5]
    assert it.clock.now() == 4.2


def test_two_interpreters_share_a_clock_in_the_order_of_time() -> None:
    seen: list[tuple[str, float]] = []
    clock = VirtualClock()
    for name, delay in (("slow", "300ms"), ("fast", "200ms")):
        machine = Machine.from_dict({"id": name, "states": {"a": {"after": {delay: "a"}}}})
        Interpreter(machine, clock, observe=lambda s, n=name: seen.append((n, s.snapshot.at))).start()
    seen.clear()
    clock.advance(0.65)
    assert [name for name, _ in seen] == ["fast", "slow", "fast", "slow", "fast"]


def test_an_observer_may_answer() -> None:
    def answer(taken: Step) -> None:
        for command in taken.commands:
            if id := getattr(command, "id", ""):
                it.send(f"done.command.{id}")

    it = Interpreter(Machine.from_dict(TOUR), observe=answer)
    it.start()
    it.send("face")
    it.clock.wait(2.0)
    assert it.configuration == frozenset({"rest"})


def test_time_never_goes_back() -> None:
    machine = Machine.from_dict({"states": {"a": {"on": {"go": "b"}}, "b": {"after": {"1s": "a"}}}})
    later = step(machine, initial(machine, at=5.0).snapshot, Event("go", at=1.0))
    assert (later.snapshot.at, due(later.snapshot)) == (5.0, Event("after.1s.b", None, 6.0, "after.1s.b"))


def test_a_step_changes_nothing_that_it_was_given() -> None:
    machine = Machine.from_dict(TOUR)
    before = initial(machine).snapshot
    copy = (before.configuration, dict(before.context), before.timers, dict(before.doing))
    first, again = (step(machine, before, Event("face", at=1.0)) for _ in range(2))
    assert (before.configuration, before.context, before.timers, before.doing) == copy
    assert first == again


def test_input_gives_first_values() -> None:
    machine = Machine.from_dict(TOUR)
    assert initial(machine, input={"visits": 3}).snapshot.context["visits"] == 3
    with pytest.raises(UsageError, match=r"visist.*did you mean `visits`"):
        initial(machine, input={"visist": 3})
    with pytest.raises(UsageError, match="`visits` is a number"):
        initial(machine, input={"visits": "three"})


def test_the_hour_is_that_of_the_event() -> None:
    machine = Machine.from_dict({"states": {"a": {"on": {"go": {"guard": "hour() >= 18", "target": "b"}}}, "b": None}})
    morning, evening = (initial(machine, epoch=h * 3600.0).snapshot for h in (17.0, 17.75))
    assert not step(machine, morning, Event("go", at=1800.0)).entered
    assert step(machine, evening, Event("go", at=1800.0)).entered == ("b",)


def test_alternatives_are_drawn_from_the_snapshot() -> None:
    machine = Machine.from_dict({"states": {"a": {"on": {"go": {"actions": {"say": {"any": ["x", "y", "z"]}}}}}}})

    def said(seed: int) -> list[str]:
        snapshot, texts = initial(machine, seed=seed).snapshot, []
        for _ in range(20):
            taken = step(machine, snapshot, Event("go"))
            snapshot = taken.snapshot
            texts.append(taken.commands[0].command.text)  # type: ignore[union-attr]
        return texts

    assert said(1) == said(1) != said(2)
    assert set(said(1)) == {"x", "y", "z"}


def test_a_restored_interpreter_goes_on_with_its_do() -> None:
    it = running()
    again = Interpreter.restore(it.machine, json.loads(json.dumps(it.snapshot())))
    for each in (it, again):
        each.send("done.command.d1")
        each.clock.wait(2.0)
        each.send("done.command.d2")
    assert again.snapshot() == it.snapshot()
    assert again.configuration == frozenset({"rest"})


@for_each(
    ("change", "difference"),
    [
        ({"id": "other"}, "it belongs to `tour`"),
        ({"states": {"idle": None}}, "state `greet` is gone"),
        ({"states": {**TOUR["states"], "dance": None}}, "state `dance` is new"),  # type: ignore[dict-item]
        ({"context": {"visits": 0}, "types": {}}, "context key `visitor` is gone"),
        ({"context": {"visits": 1, "visitor": None}}, "their content differs"),
    ],
)
def test_another_machines_snapshot_is_refused(change: dict[str, Any], difference: str) -> None:
    snapshot = running().snapshot()
    states = change.get("states", TOUR["states"])
    with pytest.raises(SnapshotError, match=difference):
        Interpreter.restore(Machine.from_dict({**TOUR, **change, "states": states}), snapshot)


def test_use_in_the_wrong_order_is_refused() -> None:
    it = Interpreter(Machine.from_dict(TOUR))
    with pytest.raises(UsageError, match="start"):
        it.send("face")
    it.start()
    with pytest.raises(UsageError, match="already"):
        it.start()


def test_a_send_that_answers_itself_ends_in_an_error() -> None:
    it = Interpreter(Machine.from_dict({"states": {"a": {"on": {"go": {"actions": {"send": "go"}}}}}}))
    it.start()
    with pytest.raises(LumenError, match="`go` is sent repeatedly"):
        it.send("go")


def test_timers_that_set_ever_more_timers_end_in_an_error() -> None:
    later = {"send": {"delay": "0.01ms", "event": "go"}}
    machine = Machine.from_dict({"entry": later, "on": {"go": {"actions": [later, later]}}, "states": {"a": {}}})
    reached = [initial(machine).snapshot]
    with pytest.raises(LumenError, match="its timers start more than 10,000 new timers per second, among them `go`"):
        reached.extend(taken.snapshot for taken in elapse(machine, lambda: reached[-1], 0.02))
    assert 1000 < len(reached[-1].timers) < MAX_TIMERS


def test_a_send_is_refused_where_too_many_wait() -> None:
    many = [{"send": {"event": "late", "delay": "1h"}}] * 100
    it = Interpreter(Machine.from_dict({"on": {"face": {"actions": [*many, {"log": "sent"}]}}, "states": {"a": {}}}))
    it.start()
    *_, last, refused = [it.send("face") for _ in range(MAX_TIMERS // 100 + 1)]
    assert last.commands
    assert not refused.commands
    (error,) = refused.raised
    assert (error.name, error.data["reason"]) == (
        "error.execution",
        "`late` is not sent: 10,000 timers are already waiting",
    )
    assert len(it.snapshot()["timers"]) == MAX_TIMERS


def test_a_context_key_keeps_to_its_whole_schema() -> None:
    counting = {"assign": {"n": "context.n + 1"}}
    types = {"n": {"type": "integer", "maximum": 1}, "way": {"enum": ["left", "right"]}}
    turning = {"on": {"go": {"actions": counting}, "turn": {"actions": {"assign": {"way": "event.data"}}}}}
    machine = Machine.from_dict({"context": {"n": 0, "way": "left"}, "types": types, "states": {"a": turning}})
    it = Interpreter(machine)
    it.start()
    assert not it.send("go").raised
    assert "`n` can't become 2: 2 is greater than the maximum of 1" in it.send("go").raised[0].data["reason"]
    assert not it.send("turn", "right").raised
    assert "`way` can't become 'up'" in it.send("turn", "up").raised[0].data["reason"]
    assert it.context == {"n": 1, "way": "right"}
    with pytest.raises(UsageError, match="`n` can't be 7"):
        initial(machine, input={"n": 7})


@for_each(
    ("context", "types", "code"),
    [
        ({"n": "x"}, {"n": {"type": "integer"}}, "wrong-value"),
        ({"n": 7}, {"n": {"type": "integer", "maximum": 1}}, "wrong-value"),
        ({"n": 7}, {"n": {"type": "intger"}}, "wrong-value"),
        ({"n": 7}, {"n": {"minimum": "x"}}, "wrong-type"),
        ({"n": [0, float("inf")]}, {}, "not-a-number"),
    ],
)
def test_a_context_that_can_not_be_is_told(context: Any, types: Any, code: str) -> None:
    with pytest.raises(ProjectError) as caught:
        Machine.from_dict({"context": context, "types": types, "states": {"a": None}})
    assert code in {d.code for d in caught.value.diagnostics}


@pytest.mark.slow
def test_a_thousand_and_more_timers_may_end_at_once() -> None:
    sends = [{"send": {"event": "x", "delay": "1s"}} for _ in range(1500)]
    data = {"context": {"n": 0}, "states": {"a": {"entry": sends, "on": {"x": {"actions": COUNTING}}}}}
    it = Interpreter(Machine.from_dict(data))
    it.start()
    it.clock.advance(1.0)
    assert it.context == {"n": 1500}


@pytest.mark.parametrize("dt", [-1.0, float("inf"), float("nan")])
def test_a_time_that_never_passes_is_refused(dt: float) -> None:
    it = running()
    with pytest.raises(UsageError, match="advance"):
        it.clock.advance(dt)
    assert it.clock.now() == 0.0


def test_no_time_is_no_later_than_any() -> None:
    machine = Machine.from_dict({"context": {"n": 0}, "states": {"a": {"on": {"go": {"actions": COUNTING}}}}})
    for name in ("go", "nobody"):
        assert step(machine, initial(machine, at=2.0).snapshot, Event(name, at=float("nan"))).snapshot.at == 2.0


def test_an_input_that_is_no_map_is_told() -> None:
    with pytest.raises(UsageError, match="the input of `tour` must be a map"):
        initial(Machine.from_dict(TOUR), input=["visits"])  # type: ignore[arg-type]


ENDING = {
    "id": "visit",
    "context": {"seen": 2},
    "on": {"*": ".talk"},
    "after": {"1min": ".talk"},
    "states": {
        "talk": {"do": {"say": "Hello"}, "on": {"leave": "bye"}},
        "bye": {"type": "final", "output": {"seen": "context.seen + 1"}},
    },
}


def test_a_machine_that_has_ended_hears_nothing_and_says_what_it_gives() -> None:
    it = Interpreter(Machine.from_dict(ENDING))
    it.start()
    assert (it.done, it.output) == (False, None)
    taken = it.send("leave")
    assert (it.done, it.output, it.configuration) == (True, {"seen": 3}, {"bye"})
    assert [str(command) for command in taken.commands] == ["Cancel(id='d1')"]
    it.clock.wait(100.0)
    assert it.send("back").transitions == ()
    assert it.send("done.command.d1").transitions == ()
    assert (it.done, it.configuration, it.next_due()) == (True, {"bye"}, None)


def test_an_end_outlives_the_disk() -> None:
    it = Interpreter(Machine.from_dict(ENDING))
    it.start()
    it.send("leave")
    again = Interpreter.restore(it.machine, json.loads(json.dumps(it.snapshot())))
    assert (again.done, again.output) == (True, {"seen": 3})
    assert again.send("back").transitions == ()


def test_an_end_that_an_older_lumen_did_not_keep_is_one() -> None:
    it = Interpreter(Machine.from_dict(ENDING))
    it.start()
    before = it.snapshot()
    it.send("leave")
    older = {**it.snapshot(), "timers": before["timers"]}
    del older["output"]
    again = Interpreter.restore(it.machine, older)
    again.clock.wait(100.0)
    assert (again.done, again.output, again.configuration) == (True, None, {"bye"})
