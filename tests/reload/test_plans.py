"""Edits that authors make, one by one: the states that remain, the targets of the rest, and the memory kept."""

from typing import Any

import pytest

from lumen.insight.migration import MigrationDelay, MigrationPlan, MigrationVerdict, Refusal, migrate
from lumen.language.commands import Cancel, Log, Play, Say, Start
from lumen.language.events import Event
from lumen.statechart import Machine, Snapshot, deserialize, initial, serialize, step

NAMED = {"context": {"visitor": "", "tries": 0}}
TOUR: dict[str, Any] = {
    **NAMED,
    "id": "tour",
    "states": {
        "idle": {"on": {"face": {"target": "talk", "actions": {"assign": {"visitor": "'Ada'"}}}}},
        "talk": {
            "entry": {"log": "hello"},
            "exit": {"log": "bye"},
            "after": {"30s": "idle"},
            "states": {
                "ask": {"exit": {"log": "asked"}, "after": {"5s": "dance"}},
                "dance": {"do": [{"say": "look"}, {"play": "dance"}], "onDone": "ask"},
            },
        },
    },
}


def talk(states: dict[str, Any], **more: Any) -> dict[str, Any]:
    """Return the tour with other states in `talk`, and more keys of it."""
    changed = {**TOUR["states"]["talk"], "states": states, **more}
    return {**TOUR, "states": {**TOUR["states"], "talk": changed}}


ASK, DANCE = TOUR["states"]["talk"]["states"].values()


def at(data: dict[str, Any], *events: tuple[str, float]) -> tuple[Machine, Snapshot]:
    """Return the machine, and its snapshot after these events."""
    machine = Machine.from_dict(data)
    snapshot = initial(machine).snapshot
    for name, time in events:
        snapshot = step(machine, snapshot, Event(name, None, time, name if name.startswith("after.") else "")).snapshot
    return machine, snapshot


ASKING = at(TOUR, ("face", 1.0))
DANCING = at(TOUR, ("face", 1.0), ("after.5s.talk.ask", 6.0))


def reload(before: tuple[Machine, Snapshot], data: dict[str, Any], time: float = 8.0, **how: bool) -> MigrationVerdict:
    return migrate(*[before[0], Machine.from_dict(data)], before[1], at=time, **how)


def planned(before: tuple[Machine, Snapshot], data: dict[str, Any], time: float = 8.0, **how: bool) -> MigrationPlan:
    verdict = reload(before, data, time, **how)
    assert isinstance(verdict, MigrationPlan), verdict
    machine = Machine.from_dict(data)
    assert deserialize(machine, serialize(machine, verdict.snapshot)) == verdict.snapshot
    return verdict


def active(plan: MigrationPlan) -> set[str]:
    return set(plan.snapshot.configuration)


def test_a_renamed_state_is_the_same_state() -> None:
    states = {"question": ASK, "dance": {**DANCE, "onDone": "question"}}
    plan = planned(ASKING, {**talk(states), "renamed": {"talk.ask": "talk.question"}})
    assert active(plan) == {"talk", "talk.question"}
    assert plan.commands == ()
    assert [(t.event, t.due) for t in plan.snapshot.timers] == [
        ("after.30s.talk", 31.0),
        ("after.5s.talk.question", 6.0),
    ]
    assert plan.snapshot.context["visitor"] == "Ada"


def test_a_renamed_state_takes_those_within_along() -> None:
    data = {
        **TOUR,
        "renamed": {"talk": "chat"},
        "states": {"idle": {"on": {"face": "chat"}}, "chat": TOUR["states"]["talk"]},
    }
    assert active(planned(ASKING, data)) == {"chat", "chat.ask"}
    assert active(planned(DANCING, data)) == {"chat", "chat.dance"}


def test_a_state_that_is_gone_and_was_not_renamed_is_refused_with_a_hint() -> None:
    verdict = reload(ASKING, talk({"dance": {**DANCE, "onDone": "dance"}}))
    assert isinstance(verdict, Refusal)
    assert "`talk.ask` is active but was removed" in verdict.reason
    assert verdict.hint == "give `talk` an `onReload`, or write the new name of `talk.ask` under `renamed`"
    assert (verdict.state, verdict.behavior, verdict.where) == ("talk.ask", "tour", ("states", "talk"))


def test_on_reload_says_where_to_go_after_the_old_exit_actions() -> None:
    data = talk({"dance": {"do": {"say": "new"}}}, onReload=".dance", exit={"log": "never said"})
    plan = planned(ASKING, data)
    assert active(plan) == {"talk", "talk.dance"}
    assert plan.leaving == (Log("asked"),)
    assert plan.entering == (Start("d1", Say("new")),)
    assert plan.notes == ("`talk.ask` is gone: the behaviour goes to `talk.dance`",)


def test_an_on_reload_further_out_counts_where_none_is_nearer() -> None:
    data = {**talk({"dance": {}}), "onReload": ".idle"}
    plan = planned(ASKING, data)
    assert active(plan) == {"idle"}
    assert plan.leaving == (Log("asked"), Log("bye"))


def test_what_a_state_does_is_waited_for_only_where_it_is_gone_or_changed() -> None:
    assert isinstance(
        reload(DANCING, talk({"ask": ASK, "dance": {"do": [{"say": "LOOK"}, {"play": "x"}]}})), MigrationPlan
    )
    assert isinstance(reload(DANCING, talk({"ask": ASK, "dance": {"do": [{"play": "x"}]}})), MigrationDelay)
    ask = {**ASK, "after": {"5s": "ask"}}
    gone = reload(DANCING, talk({"ask": ask}))
    assert gone == MigrationDelay("`talk.dance` is gone, but is still busy", "talk.dance")
    assert isinstance(reload(DANCING, talk({"ask": ask}), now=True), Refusal)
    plan = planned(DANCING, talk({"ask": ask}, onReload=".ask"), now=True)
    assert plan.leaving == (Cancel("d1"),)
    assert plan.snapshot.doing == {}


def test_a_changed_do_begins_anew_where_it_was_cancelled() -> None:
    plan = planned(DANCING, talk({"ask": ASK, "dance": {"do": {"play": "x"}, "onDone": "ask"}}), now=True)
    assert plan.commands == (Cancel("d1"), Start("d2", Play("x")))
    assert plan.exited == plan.entered == ()


def test_a_running_command_of_another_motion_is_waited_for() -> None:
    machine, snapshot = DANCING
    playing = machine, step(machine, snapshot, Event("done.command.d1", None, 7.0)).snapshot
    assert isinstance(
        reload(playing, talk({"ask": ASK, "dance": {"do": [{"say": "x"}, {"play": "y"}]}})), MigrationDelay
    )
    assert isinstance(
        reload(playing, talk({"ask": ASK, "dance": {"do": [*DANCE["do"], {"say": "more"}]}})), MigrationPlan
    )


def test_a_state_that_now_has_states_begins_them() -> None:
    plan = planned(ASKING, talk({"ask": {**ASK, "states": {"a": {"entry": {"log": "a"}}, "b": {}}}, "dance": DANCE}))
    assert active(plan) == {"talk", "talk.ask", "talk.ask.a"}
    assert plan.commands == (Log("a"),)


def test_a_state_that_has_no_states_any_more_stays() -> None:
    plan = planned(ASKING, {**TOUR, "states": {**TOUR["states"], "talk": {"entry": {"log": "no"}}}})
    assert active(plan) == {"talk"}
    assert plan.leaving == (Log("asked"),)


def test_the_active_state_turned_parallel_keeps_what_is_active_and_begins_the_rest() -> None:
    plan = planned(ASKING, talk({"ask": {"entry": {"log": "no"}}, "dance": DANCE}, type="parallel"))
    assert active(plan) == {"talk", "talk.ask", "talk.dance"}
    assert plan.entering == (Start("d1", Say("look")),)


BOTH = {"id": "m", "type": "parallel", "states": {"a": {"states": {"x": {}, "y": {}}}, "b": {"exit": {"log": "b"}}}}


def test_regions_come_and_go() -> None:
    more = {**BOTH, "states": {**BOTH["states"], "c": {"entry": {"log": "c"}}}}
    assert planned(at(BOTH), more).commands == (Log("c"),)
    assert active(planned(at(BOTH), more)) == {"a", "a.x", "b", "c"}
    fewer = {**BOTH, "states": {"a": BOTH["states"]["a"]}}
    assert planned(at(BOTH), fewer).commands == (Log("b"),)
    assert active(planned(at(BOTH), fewer)) == {"a", "a.x"}


def test_what_can_not_be_active_together_any_more_needs_an_on_reload() -> None:
    alone = {**BOTH, "type": "compound"}
    verdict = reload(at(BOTH), alone)
    assert isinstance(verdict, Refusal)
    assert verdict.reason == "`a` and `b` are active, but can no longer be active together in `m`"
    assert active(planned(at(BOTH), {**alone, "onReload": ".b"})) == {"b"}


def test_two_states_that_swap_their_names_swap_what_is_active_once() -> None:
    one = {"id": "m", "states": {"a": {"on": {"go": "b"}}, "b": {"entry": {"log": "x"}}}}
    two = {**one, "renamed": {"a": "b", "b": "a"}, "states": {"b": {"on": {"go": "a"}}, "a": {"entry": {"log": "x"}}}}
    swapped = planned(at(one), two)
    assert active(swapped) == {"b"}
    again = {**two, "context": {"k": 0}}
    assert active(planned((Machine.from_dict(two), swapped.snapshot), again)) == {"b"}
    back = migrate(Machine.from_dict(two), Machine.from_dict(one), swapped.snapshot, back=True)
    assert isinstance(back, MigrationPlan)
    assert active(back) == {"a"}


def test_a_name_edited_twice_in_the_same_line_is_followed() -> None:
    names = [{"id": "m", "states": {n: {"on": {"go": "z"}}, "z": {}}} for n in ("a", "b", "c")]
    first, second, third = names[0], {**names[1], "renamed": {"a": "b"}}, {**names[2], "renamed": {"a": "c"}}
    there = planned(at(first), second)
    assert active(planned((Machine.from_dict(second), there.snapshot), third)) == {"c"}
    assert active(planned(at(first), third)) == {"c"}


@pytest.mark.parametrize(
    ("context", "visitor", "notes"),
    [
        ({"visitor": "nobody", "tries": 0}, "Ada", ()),
        ({"visitor": None, "tries": 0}, "Ada", ()),
        (
            {"visitor": 0, "tries": 0},
            0,
            ("`visitor` starts again with its first value: it was a string and is now a number",),
        ),
        ({"tries": 0}, None, ("`visitor` is forgotten",)),
    ],
)
def test_the_visitors_name(context: dict[str, Any], visitor: object, notes: tuple[str, ...]) -> None:
    idle = {"on": {"face": "talk"}}
    data = {**TOUR, "context": context, "states": {**TOUR["states"], "idle": idle}}
    plan = planned(ASKING, data)
    assert plan.snapshot.context.get("visitor") == visitor
    assert plan.notes == notes


def test_the_visitors_name_under_another_name() -> None:
    states = {**TOUR["states"], "idle": {"on": {"face": "talk"}}}
    data = {
        **TOUR,
        "context": {"guest": "", "tries": 0},
        "renamed": {"context.visitor": "context.guest"},
        "states": states,
    }
    plan = planned(ASKING, data)
    assert plan.snapshot.context == {"guest": "Ada", "tries": 0}
    back = migrate(Machine.from_dict(data), ASKING[0], plan.snapshot, back=True)
    assert isinstance(back, MigrationPlan)
    assert back.snapshot.context == {"visitor": "Ada", "tries": 0}


def test_timers() -> None:
    """A changed delay counts from when it was set, a new one from now; a removed one does not fire."""
    changed = planned(ASKING, talk({"ask": {**ASK, "after": {"7s": "dance", "1min": "dance"}}, "dance": DANCE}))
    assert [(t.event, t.due) for t in changed.snapshot.timers] == [
        ("after.30s.talk", 31.0),
        ("after.7s.talk.ask", 8.0),
        ("after.1min.talk.ask", 68.0),
    ]
    none = planned(ASKING, talk({"ask": {}, "dance": DANCE}))
    assert [t.event for t in none.snapshot.timers] == ["after.30s.talk"]


def test_computed_timers() -> None:
    """A computed delay counts as it was; another text is computed in the new context, and no duration sets no timer."""
    first, longer = "{{ context.tries + 5 }}s", "{{ context.tries + 6 }}s"

    def waiting(*texts: str, tries: int = 0) -> dict[str, Any]:
        machine = talk({"ask": {**ASK, "after": dict.fromkeys(texts, "dance")}, "dance": DANCE})
        return {**machine, "context": {**TOUR["context"], "tries": tries}}

    def timers(before: tuple[Machine, Snapshot], data: dict[str, Any]) -> list[tuple[str, float]]:
        return [(t.event, t.due) for t in planned(before, data).snapshot.timers if t.state == "talk.ask"]

    constant, computed = at(waiting("5s"), ("face", 1.0)), at(waiting(first), ("face", 1.0))
    assert timers(computed, waiting(first, tries=3)) == [(f"after.{first}.talk.ask", 6.0)]
    assert timers(computed, waiting(longer)) == [(f"after.{longer}.talk.ask", 7.0)]
    assert timers(computed, waiting("9s")) == [("after.9s.talk.ask", 10.0)]
    assert timers(constant, waiting(longer)) == [(f"after.{longer}.talk.ask", 7.0)]
    assert timers(computed, waiting(first, longer)) == [
        (f"after.{first}.talk.ask", 6.0),
        (f"after.{longer}.talk.ask", 14.0),
    ]
    broken = planned(computed, waiting("{{ context.tries - 9 }}s"))
    assert [t.event for t in broken.snapshot.timers] == ["after.30s.talk"]
    assert deserialize(computed[0], serialize(*computed)).timers == computed[1].timers


def test_what_is_new_in_a_state_that_stays_begins() -> None:
    plan = planned(ASKING, talk({"ask": {**ASK, "do": {"say": "well?"}}, "dance": DANCE}))
    assert plan.commands == (Start("d1", Say("well?")),)
    assert plan.entered == ()


def test_another_beginning_or_another_id_changes_nothing_now() -> None:
    assert planned(ASKING, {**TOUR, "initial": "talk", "id": "other"}).commands == ()
    assert active(planned(ASKING, {**TOUR, "initial": "talk", "id": "other"})) == {"talk", "talk.ask"}


def test_a_state_that_is_final_now_ends_what_it_is_in() -> None:
    data = talk({"ask": {"type": "final"}, "dance": {}}, onDone="idle")
    assert active(planned(ASKING, data)) == {"idle"}


def test_another_behaviour_goes_on_only_where_it_says_so() -> None:
    other = {"id": "other", "states": {"begin": {}}}
    assert isinstance(reload(ASKING, other), Refusal)
    assert active(planned(ASKING, {**other, "onReload": ".begin"})) == {"begin"}


def test_an_always_that_holds_now_is_taken_at_once() -> None:
    data = talk({"ask": {**ASK, "always": {"guard": "context.visitor == 'Ada'", "target": "dance"}}, "dance": DANCE})
    assert active(planned(ASKING, data)) == {"talk", "talk.dance"}


def test_what_never_comes_to_rest_is_refused() -> None:
    data = talk({"ask": {"always": {"guard": "context.tries < 9", "target": "dance"}}, "dance": {"always": "ask"}})
    verdict = reload(ASKING, data)
    assert isinstance(verdict, Refusal)
    assert "never comes to rest" in verdict.reason


def test_history_follows() -> None:
    halls = {"a": {}, "b": {"on": {"out": "#outside"}}, "h": {"type": "history"}}
    data = {
        "id": "m",
        "states": {"in": {"initial": "b", "states": halls}, "outside": {"id": "outside", "on": {"back": "in.h"}}},
    }
    where = at(data, ("out", 1.0))
    renamed = {**data, "renamed": {"in.b": "in.c"}, "states": {**data["states"], "in": {"states": {
        "a": {}, "c": {"on": {"out": "#outside"}}, "h": {"type": "history"}}}}}  # fmt: skip
    machine = Machine.from_dict(renamed)
    back = step(machine, planned(where, renamed).snapshot, Event("back", None, 9.0))
    assert back.snapshot.configuration == {"in", "in.c"}


ENDING: dict[str, Any] = {
    "states": {
        "talk": {"on": {"leave": "bye"}},
        "bye": {"type": "final", "entry": {"log": "so long"}, "exit": {"log": "gone"}, "output": 7},
    },
}
ENDED = at(ENDING, ("leave", 1.0))


def ending(talk: dict[str, Any], bye: dict[str, Any], **more: Any) -> dict[str, Any]:
    return {"states": {"talk": talk, "bye": bye, **more}}


def test_what_has_ended_stays_so_and_nothing_new_begins() -> None:
    bye = {**ENDING["states"]["bye"], "output": 8}
    plan = planned(ENDED, {**ending({}, bye), "after": {"1s": ".talk"}, "do": {"say": "Hello"}, "exit": {"log": "x"}})
    assert (plan.commands, plan.exited, plan.entered) == ((), (), ())
    assert (plan.snapshot.configuration, plan.snapshot.output, plan.snapshot.timers) == ({"bye"}, 7, ())


@pytest.mark.parametrize(
    "data",
    [
        ending(ENDING["states"]["talk"], {"on": {"back": "talk"}}),
        {"states": {"talk": {}}, "onReload": ".talk"},
        {"states": {"talk": {}}},
        ending({}, {"states": {"a": {}, "b": {"type": "final"}}}),
    ],
)
def test_a_reload_brings_nothing_to_life_that_has_ended(data: dict[str, Any]) -> None:
    verdict = reload(ENDED, data)
    assert isinstance(verdict, Refusal)
    assert "has ended in `bye`" in verdict.reason


def test_a_state_that_becomes_final_ends_the_behaviour() -> None:
    before = at(ending({"on": {"leave": "bye"}}, {"do": {"say": "so long"}}), ("leave", 1.0))
    plan = planned(before, {**ENDING, "on": {"*": ".talk"}}, now=True)
    assert [c for c in plan.commands if isinstance(c, Log)] == [Log("so long"), Log("gone")]
    assert (plan.snapshot.configuration, plan.snapshot.output) == ({"bye"}, 7)
