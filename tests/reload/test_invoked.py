"""Behaviours that run within another one, under other files."""

from typing import Any

from lumen.insight.migration import MigrationDelay, MigrationPlan, Refusal, migrate
from lumen.language.commands import Cancel, Log, Say, Start
from lumen.language.events import Event
from lumen.statechart import Machine, deserialize, initial, serialize, step

QUIZ: dict[str, Any] = {
    "context": {"asked": 0},
    "states": {
        "ask": {
            "do": [{"say": "Well?"}, {"wait": "2s"}],
            "exit": {"log": "asked"},
            "onDone": "end",
            "after": {"9s": "end"},
        },
        "hint": {"on": {"more": "ask"}, "exit": {"log": "hinted"}},
        "end": {"type": "final", "output": {"asked": "context.asked"}},
    },
}
INVOKE = {"behavior": "quiz", "input": {"asked": "context.asked"}, "onDone": "b"}


def tour(quiz: dict[str, Any] = QUIZ, **a: Any) -> Machine:
    state = {"invoke": INVOKE, "on": {"go": "b"}, **a}
    data = {"id": "tour", "context": {"asked": 3}, "states": {"a": state, "b": None, "c": None}}
    return Machine.from_dict(data, "tour", {"quiz": quiz, "other": QUIZ})


OLD = tour()
ASKING = initial(OLD).snapshot
RESTING = step(OLD, ASKING, Event("done.command.d1@quiz", None, 0.5)).snapshot


def planned(new: Machine, **how: Any) -> MigrationPlan:
    verdict = migrate(OLD, new, ASKING, at=1.0, **how)
    assert isinstance(verdict, MigrationPlan), verdict
    assert deserialize(new, serialize(new, verdict.snapshot)) == verdict.snapshot
    return verdict


def test_it_goes_on_where_something_else_has_changed() -> None:
    plan = planned(tour(after={"7s": "b"}))
    assert plan.commands == ()
    assert plan.snapshot.invoked["quiz"].snapshot.doing == ASKING.invoked["quiz"].snapshot.doing


def test_other_input_is_for_the_next_time() -> None:
    plan = planned(tour(invoke={**INVOKE, "input": {"asked": 9}}))
    assert plan.commands == ()
    assert plan.snapshot.invoked["quiz"].snapshot.context == {"asked": 3}


def test_its_own_file_may_change_by_the_same_rules() -> None:
    ask = {**QUIZ["states"]["ask"], "do": [{"say": "Well then?"}, {"wait": "4s"}]}
    plan = planned(tour({**QUIZ, "context": {"asked": 0, "more": 1}, "states": {**QUIZ["states"], "ask": ask}}))
    assert plan.commands == ()
    child = plan.snapshot.invoked["quiz"].snapshot
    assert child.context == {"asked": 3, "more": 1}
    assert [t.due for t in child.timers] == [9.0]


def test_what_it_does_is_waited_for_where_it_changed_and_cancelled_with_now() -> None:
    ask = {**QUIZ["states"]["ask"], "do": {"play": "x"}}
    changed = tour({**QUIZ, "states": {**QUIZ["states"], "ask": ask}})
    assert migrate(OLD, changed, ASKING) == MigrationDelay(
        "these files change the `do` of `ask`, which is still running", "ask"
    )
    assert planned(changed, now=True).leaving == (Cancel("d1@quiz"),)


def test_a_state_of_it_that_is_gone_needs_an_on_reload_in_its_file() -> None:
    gone = {**QUIZ, "states": {"end": QUIZ["states"]["end"], "hint": {"on": {"more": "end"}}}}
    assert isinstance(migrate(OLD, tour(gone), ASKING), MigrationDelay)
    verdict = migrate(OLD, tour(gone), ASKING, now=True)
    assert isinstance(verdict, Refusal)
    assert verdict.behavior == "quiz"
    plan = planned(tour({**gone, "onReload": ".hint"}), now=True)
    assert plan.leaving == (Log("asked"), Cancel("d1@quiz"))
    ended = planned(tour({**gone, "onReload": ".end"}), now=True)
    assert ended.snapshot.configuration == {"b"}
    assert ended.snapshot.invoked == {}


def test_another_behaviour_in_its_place_begins_when_it_has_ended() -> None:
    other = tour(invoke={**INVOKE, "id": "quiz", "behavior": "other"})
    assert migrate(OLD, other, ASKING) == MigrationDelay("`quiz` is no longer invoked, but is still busy", "quiz")
    plan = planned(other, now=True)
    assert plan.leaving == (Log("asked"), Cancel("d1@quiz"))
    assert plan.entering == (Start("d2@quiz", Say("Well?")),)


def test_one_that_is_new_in_an_active_state_begins() -> None:
    none = tour(invoke=[])
    verdict = migrate(none, OLD, initial(none).snapshot)
    assert isinstance(verdict, MigrationPlan)
    assert verdict.entering == (Start("d1@quiz", Say("Well?")),)


def test_what_it_sends_as_it_changes_comes_to_the_one_that_invoked_it() -> None:
    asking = {**QUIZ["states"]["ask"], "exit": {"send": {"event": "lost", "to": "parent"}}}
    before = tour({**QUIZ, "states": {**QUIZ["states"], "ask": asking}}, on={"lost": "b", "told": "c"})
    hint = {"entry": {"send": {"event": "told", "to": "parent"}}}
    gone = {"states": {"hint": hint, "end": QUIZ["states"]["end"]}, "context": {"asked": 0}, "onReload": ".hint"}
    after = tour(gone, on={"lost": {"actions": {"log": "lost"}}, "told": "c"})
    verdict = migrate(before, after, initial(before).snapshot, at=1.0, now=True)
    assert isinstance(verdict, MigrationPlan), verdict
    assert Log("lost") in verdict.entering
    assert verdict.snapshot.configuration == {"c"}
    assert not verdict.snapshot.invoked
