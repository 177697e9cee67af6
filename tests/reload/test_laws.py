"""Laws of every reload: random machines, random edits, any snapshot of a behaviour."""

from contextlib import suppress
from copy import deepcopy

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from lumen.errors import LumenError
from lumen.insight.migration import MigrationDelay, MigrationPlan, Refusal, migrate
from lumen.language.commands import Log
from lumen.language.machines import StateKind
from lumen.statechart import Machine, Snapshot, deserialize, initial, serialize, step
from tests.reload.editing import Happenings, built, edits, happen, snapshots, states_of
from tests.statechart.oracle.generating import Data, happenings, machine_data
from tests.statechart.test_laws import HAPPENINGS, machines, run, running

PATIENT = settings(
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow, HealthCheck.data_too_large, HealthCheck.filter_too_much],
)


def assert_sound(machine: Machine, snapshot: Snapshot) -> None:
    """Check that the configuration is legal, that nothing waits for an inactive state, and that it can be stored."""
    assert deserialize(machine, serialize(machine, snapshot)) == snapshot
    for inner, stands in running(machine, snapshot):
        names = stands.configuration
        active = {path for path, state in inner.states.items() if not path or state.name in names}
        for path in active:
            state = inner.states[path]
            children = [child for child in state.children if inner.states[child].kind is not StateKind.HISTORY]
            within = [child for child in children if child in active]
            assert path == "" or state.parent in active
            assert len(within) == {StateKind.COMPOUND: 1, StateKind.PARALLEL: len(children)}.get(state.kind, 0)
        assert stands.doing.keys() <= active
        assert {timer.state for timer in stands.timers if timer.kind != "send"} <= active
        assert {child.state for child in stands.invoked.values()} <= active
        assert stands.context.keys() == inner.context.keys()


@pytest.mark.slow
@settings(PATIENT, max_examples=15)
@given(st.data(), machine_data(deeds=True), happenings, happenings)
def test_a_plan_is_legal_and_goes_on(data: st.DataObject, old: Data, events: Happenings, later: Happenings) -> None:
    legal(data, old, events, later)


def legal(data: st.DataObject, old: Data, events: Happenings, later: Happenings) -> None:
    """Check that a reload is sound, or refused, or waits for a `do` that is under way; with `now` nothing waits."""
    before, after = Machine.from_dict(old), built(data.draw(edits(old) | machine_data(deeds=True)))
    for snapshot in snapshots(before, events) if after else ():
        first = migrate(before, after, snapshot, at=snapshot.at + 0.01)
        for verdict in (first, migrate(before, after, snapshot, at=snapshot.at + 0.01, now=True)):
            match verdict:
                case Refusal(reason, hint):
                    assert reason
                    assert hint
                case MigrationDelay(_, what):
                    assert verdict is first
                    assert any(before.states[path].name == what for path in snapshot.doing)
                case MigrationPlan():
                    assert_sound(after, verdict.snapshot)
                    with suppress(LumenError):
                        goes_on(after, verdict.snapshot, later)


def goes_on(machine: Machine, snapshot: Snapshot, events: Happenings) -> None:
    for event in events:
        snapshot = step(machine, snapshot, happen(snapshot, event)).snapshot
        assert_sound(machine, snapshot)


@pytest.mark.slow
@settings(PATIENT, max_examples=4)
@given(machines(), machines(), HAPPENINGS)
def test_invoked_behaviours_are_legal_as_well(before: Machine, after: Machine, events: list[str]) -> None:
    invoked_legal(before, after, events)


def invoked_legal(before: Machine, after: Machine, events: list[str]) -> None:
    for taken in run(before, events):
        for now in (False, True):
            verdict = migrate(before, after, taken.snapshot, now=now)
            if isinstance(verdict, MigrationPlan):
                assert_sound(after, verdict.snapshot)


@pytest.mark.slow
@settings(PATIENT, max_examples=15)
@given(machine_data(deeds=True), happenings)
def test_the_same_content_does_nothing(data: Data, events: Happenings) -> None:
    before, after = Machine.from_dict(data), Machine.from_dict(deepcopy(data))
    for snapshot in snapshots(before, events):
        assert migrate(before, after, snapshot, at=snapshot.at + 1.0) == MigrationPlan(snapshot)


@pytest.mark.slow
@settings(PATIENT, max_examples=15)
@given(machine_data(deeds=True), happenings)
def test_what_differs_elsewhere_changes_nothing(data: Data, events: Happenings) -> None:
    """After adding an unreachable state, the migrated snapshot is the same as before."""
    more = deepcopy(data)
    more["context"]["more"] = 1
    before, after = Machine.from_dict(data), Machine.from_dict(more)
    for snapshot in snapshots(before, events):
        there = migrate(before, after, snapshot)
        if isinstance(there, MigrationPlan) and not there.entered:
            assert there == MigrationPlan(snapshot._replace(context={**snapshot.context, "more": 1}))
            assert migrate(after, before, there.snapshot, back=True) == MigrationPlan(snapshot)


@pytest.mark.slow
@settings(PATIENT, max_examples=30)
@given(st.data(), machine_data(deeds=True), happenings)
def test_there_and_back_restores_what_did_not_change(data: st.DataObject, old: Data, events: Happenings) -> None:
    before, after = Machine.from_dict(old), built(data.draw(edits(old)))
    for snapshot in snapshots(before, events) if after else ():
        there = migrate(before, after, snapshot, at=snapshot.at)
        if not isinstance(there, MigrationPlan) or there.exited or there.entered:
            continue
        again = migrate(after, before, there.snapshot, at=snapshot.at, back=True)
        if isinstance(again, MigrationPlan) and not again.exited and not again.entered:
            assert again.snapshot.configuration == snapshot.configuration
            assert again.snapshot.context == snapshot.context
            assert again.snapshot.generator == snapshot.generator
            ran = {t.id for t in snapshot.timers} & {t.id for t in there.snapshot.timers}
            assert [t for t in again.snapshot.timers if t.id in ran] == [t for t in snapshot.timers if t.id in ran]
            kept = {p: w for p, w in snapshot.doing.items() if p in again.snapshot.doing}
            assert kept == {p: w for p, w in again.snapshot.doing.items() if p in snapshot.doing}


@pytest.mark.slow
@settings(PATIENT, max_examples=30)
@given(st.data(), machine_data(), happenings)
def test_what_is_left_runs_its_old_exit_actions_from_the_inside(
    data: st.DataObject, old: Data, events: Happenings
) -> None:
    old = deepcopy(old)
    for path, state in states_of(old):
        if state.get("type") != "history":
            state["exit"] = {"log": f"old {path}"}
    new = data.draw(edits(old))
    for path, state in states_of(new):
        if "exit" in state:
            state["exit"] = {"log": f"new {path}"}
    before, after = Machine.from_dict(old), built(new)
    names = {state.name: path for path, state in before.states.items()}
    for snapshot in snapshots(before, events) if after else ():
        verdict = migrate(before, after, snapshot)
        if isinstance(verdict, MigrationPlan):
            said = [c.text.removeprefix("old ") for c in verdict.leaving if isinstance(c, Log)]
            order = [path for path in reversed(before.states) if path in said]
            assert said == order
            assert {names[name] for name in verdict.exited if name in names} >= set(said)
            assert not any(c.text.startswith("new") for c in verdict.leaving if isinstance(c, Log))


@pytest.mark.slow
@settings(PATIENT, max_examples=30)
@given(st.data(), machine_data(deeds=True), happenings)
def test_deadlines_are_kept(data: st.DataObject, old: Data, events: Happenings) -> None:
    before, after = Machine.from_dict(old), built(data.draw(edits(old)))
    for snapshot in snapshots(before, events) if after else ():
        verdict = migrate(before, after, snapshot, at=snapshot.at + 0.02)
        if isinstance(verdict, MigrationPlan) and not verdict.exited and not verdict.entered:
            dues = {(t.kind, t.due, t.delay) for t in snapshot.timers}
            set_at = {round(t.due - t.delay, 9) for t in snapshot.timers} | {round(snapshot.at + 0.02, 9)}
            for timer in verdict.snapshot.timers:
                moved = timer.kind == "after" and round(timer.due - timer.delay, 9) in set_at
                assert (timer.kind, timer.due, timer.delay) in dues or moved or timer.kind == "wait"


@pytest.mark.slow
@settings(PATIENT, max_examples=10)
@given(st.data(), machine_data(deeds=True), happenings)
def test_a_plan_is_pure(data: st.DataObject, old: Data, events: Happenings) -> None:
    before, after = Machine.from_dict(old), built(data.draw(edits(old)))
    for snapshot in snapshots(before, events) if after else ():
        stored = serialize(before, snapshot)
        assert migrate(before, after, snapshot, now=True) == migrate(before, after, snapshot, now=True)
        assert serialize(before, snapshot) == stored
        assert initial(before) == initial(Machine.from_dict(old))


@pytest.mark.soak
@settings(PATIENT, max_examples=1000)
@given(st.data(), machine_data(deeds=True), happenings, happenings)
def test_a_thousand_edits(data: st.DataObject, old: Data, events: Happenings, later: Happenings) -> None:
    legal(data, old, events, later)


@pytest.mark.soak
@settings(PATIENT, max_examples=200)
@given(machines(), machines(), HAPPENINGS)
def test_two_hundred_behaviours_within_others(before: Machine, after: Machine, events: list[str]) -> None:
    invoked_legal(before, after, events)
