"""A rollout: its steps, its three verdicts, and that no more robots than its step run an unproved bundle."""

from collections.abc import Callable
from dataclasses import replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lumen.features.fleet.rollouts.rollout import abort, allowed, begin, decide, step, take_over
from lumen.features.fleet.rollouts.state import ABORTED, FINISHED, PERSON
from lumen.features.fleet.settings import FleetGroup, RolloutPlan, StepTarget
from tests.features.fleet.world import OLD, PLAN, World

NEW, NEXT = "b" * 64, "c" * 64


def until(world: World, holds: Callable[[], bool], ticks: int = 400) -> None:
    for _ in range(ticks):
        world.tick()
        if holds():
            return
    pytest.fail(f"it never came to that: {world.centre.rollout}")


def state_of(world: World) -> str:
    return world.centre.rollout.state if world.centre.rollout else ""


def test_a_good_bundle_comes_to_everybody_step_by_step() -> None:
    world, most = World(20, 1), []
    world.roll(NEW)
    until(world, lambda: most.append(world.on(NEW)) or state_of(world) == FINISHED)
    assert world.centre.proved == (NEW,)
    assert {2, 6} <= set(most)
    assert world.on(NEW) > 10
    until(world, lambda: world.on(NEW) == 20)


def test_one_that_falls_sends_all_back() -> None:
    world = World(20, 2)
    world.roll(NEW)
    until(world, lambda: world.on(NEW) == 6)
    next(robot for robot in world.robots.values() if robot.bundle == NEW).falls = 1
    until(world, lambda: world.on(NEW) == 0)
    assert state_of(world) == ABORTED
    assert "`falls > 0` holds: falls " in world.centre.rollout.reason
    until(world, lambda: not world.centre.exposed)


def test_one_that_does_not_stand_its_probation_sends_all_back() -> None:
    world = World(20, 3)
    for robot in world.robots.values():
        robot.fails = frozenset((NEW,))
    world.roll(NEW)
    until(world, lambda: state_of(world) == ABORTED and world.on(NEW) == 0)
    assert "rolled back" in world.centre.rollout.reason


def test_what_can_not_be_measured_is_asked_a_person() -> None:
    world = World(20, 4, RolloutPlan(PLAN.steps, 60.0, "falls > 2 * before"))
    world.roll(NEW)
    for robot in world.robots.values():
        robot.presence = lambda now, said=robot.presence: replace(said(now), before={})  # type: ignore[method-assign]
    until(world, lambda: state_of(world) == PERSON)
    assert world.on(NEW) == 2
    world.approve()
    until(world, lambda: world.on(NEW) == 6)


def test_nobody_there_to_prove_it_is_asked_a_person() -> None:
    world = World(20, 5)
    world.fleet = replace(world.fleet, groups={"demo": FleetGroup(("h0/nao0",))})
    world.plan = RolloutPlan((StepTarget("demo"), StepTarget(share=1.0)), 60.0)
    world.robots["h0/nao0"].on = False
    world.roll(NEW)
    until(world, lambda: state_of(world) == PERSON)
    assert "h0/nao0" in world.centre.rollout.reason
    assert world.on(NEW) == 0


def test_a_robot_that_was_off_for_three_weeks_converges() -> None:
    world = World(6, 6)
    world.robots["h0/nao0"].on = False
    world.roll(NEW)
    until(world, lambda: state_of(world) == FINISHED)
    world.roll(NEXT)
    until(world, lambda: world.on(NEXT) >= 1)
    world.keep(abort(world.centre, "by a person"))
    world.now += 21 * 86_400.0
    world.robots["h0/nao0"].on = True
    until(world, lambda: world.on(NEW) == 6)


def test_a_second_rollout_waits_for_robots_that_have_not_come_back() -> None:
    world = World(20, 7)
    world.roll(NEW)
    until(world, lambda: world.on(NEW) == 2)
    world.cut = {"h0", "h1", "h2"}
    world.keep(abort(world.centre, "by a person"))
    world.roll(NEXT)
    for _ in range(20):
        world.tick()
    assert world.centre.rollout.assigned == ()
    world.cut = set()
    until(world, lambda: world.on(NEXT) == 2)
    assert world.on(NEW) == 0


def test_another_centre_of_the_same_term_is_refused_and_told() -> None:
    world = World(6, 8)
    world.tick()
    for _ in range(5):
        world.down.append((world.now, world.stranger("h0", NEW)))
        world.tick()
    assert world.on(NEW) == 0
    assert any("two centres" in told for told in world.robots["h0/nao0"].told)


def test_an_old_copy_of_a_centre_orders_nothing_until_it_takes_over() -> None:
    world = World(6, 9)
    copy = world.centre
    world.roll(NEW)
    until(world, lambda: world.on(NEW) == 1)
    world.keep(replace(copy, looked=world.now))
    until(world, lambda: bool(world.centre.overruled))
    with pytest.raises(ValueError, match="an old copy"):
        begin(world.centre, world.fleet, NEXT, PLAN, world.now)
    world.keep(take_over(world.centre, world.heard))
    assert not step(world.centre, world.fleet, world.heard, world.now).overruled


def test_a_clock_that_is_set_ahead_hurries_nothing() -> None:
    world = World(20, 10, RolloutPlan(PLAN.steps, 1800.0))
    world.roll(NEW)
    until(world, lambda: world.on(NEW) == 2)
    world.clock_error = 86_400.0
    for _ in range(12):
        world.tick()
    assert world.centre.rollout.at == 0


def test_a_look_after_a_long_time_counts_for_half_a_minute_at_most() -> None:
    world = World(20, 12, RolloutPlan(PLAN.steps, 1800.0))
    world.roll(NEW)
    until(world, lambda: world.centre.rollout.watched > 0.0)
    later = {name: replace(row, at=row.at + 86_400.0) for name, row in world.heard.items()}
    after = step(world.centre, world.fleet, later, world.now + 86_400.0)
    assert after.rollout.watched - world.centre.rollout.watched <= 30.0


def test_a_centre_that_was_replaced_orders_nothing_more() -> None:
    world = World(6, 13)
    until(world, lambda: len(world.heard) == 6)
    old = world.centre
    world.keep(take_over(replace(old, centre="two"), world.heard))
    until(world, lambda: all(robot.followed.centre == "two" for robot in world.robots.values()))
    until(world, lambda: all(row.presence.term == 2 for row in world.heard.values()))
    assert "replaced this centre" in step(old, world.fleet, world.heard, world.now).overruled


def test_a_paused_rollout_waits_and_goes_on() -> None:
    world = World(20, 11)
    world.roll(NEW)
    until(world, lambda: world.on(NEW) == 2)
    world.keep(decide(world.centre, "paused"))
    for _ in range(40):
        world.tick()
    assert world.on(NEW) == 2
    world.keep(decide(world.centre, "going"))
    until(world, lambda: world.on(NEW) == 6)


TRIED = RolloutPlan(PLAN.steps, PLAN.pause, PLAN.abort_if, try_first=True)


def test_all_try_a_bundle_before_the_first_one_takes_it() -> None:
    world, most = World(20, 14, TRIED), []
    world.robots["h1/nao1"].on = False  # absent robots are not waited for
    world.roll(NEW)
    until(world, lambda: world.centre.rollout.tried or most.append(world.on(NEW)))
    assert {*most} == {0}
    there = [name for name, row in world.heard.items() if name != "h1/nao1"]
    assert all(world.heard[name].presence.tried["bundle"] == NEW for name in there)
    until(world, lambda: state_of(world) == FINISHED, 800)
    assert world.centre.trying == ""


def test_where_one_would_refuse_it_a_person_decides() -> None:
    world = World(20, 15, TRIED)
    world.robots["h0/nao3"].refuses = frozenset((NEW,))
    world.roll(NEW)
    until(world, lambda: state_of(world) == PERSON)
    assert world.centre.rollout.reason == "1 of 20 robots would refuse it: h0/nao3 (a:1: b)"
    assert world.on(NEW) == 0
    world.approve()
    until(world, lambda: world.on(NEW) == 2)


def test_robots_that_are_there_and_try_nothing_are_told() -> None:
    world = World(20, 16, TRIED)
    robot = world.robots["h0/nao3"]
    robot.presence = lambda now, said=robot.presence: replace(said(now), tried={})  # type: ignore[method-assign]
    world.roll(NEW)
    world.keep(decide(world.centre, "paused"))
    world.keep(decide(world.centre, "going"))
    assert not world.centre.rollout.tried
    until(world, lambda: state_of(world) == PERSON)
    assert world.centre.rollout.reason == "some robots have not tried it after 10 min: h0/nao3"
    world.keep(abort(world.centre, "by a person"))
    assert (world.centre.trying, world.on(NEW)) == ("", 0)


DEEDS = ("on", "off", "cut", "mend", "kill", "restart", "clock", "roll", "abort", "approve", "stranger", "wait", "fall")


def misfortune(count: int, seed: int, deeds: list[tuple[str, int]]) -> None:
    """Apply `deeds`; an unproved bundle never runs on more robots than the rollout's step allows."""
    world = World(count, seed, TRIED if seed % 3 == 0 else PLAN)
    names, houses, bundles = list(world.robots), list(world.fleet.houses), [NEW, NEXT, "d" * 64]
    for deed, number in deeds:
        robot = world.robots[names[number % len(names)]]
        match deed:
            case "on" | "off":
                robot.on = deed == "on"
            case "cut":
                world.cut.add(houses[number % 3])
            case "mend":
                world.cut.clear()
            case "kill":
                world.kill()
            case "restart":
                world.restart()
            case "clock":
                world.clock_error = (number - 50) * 1000.0
                robot.skew = -world.clock_error
            case "roll" if world.alive:
                world.roll(bundles[number % 3])
            case "abort" if world.alive:
                world.keep(abort(world.centre, "by a person"))
            case "approve" if world.alive:
                world.approve()
            case "fall":
                robot.falls += 1
            case "stranger":
                world.down.append((world.now + number, world.stranger(houses[number % 3], NEW)))
        for _ in range(1 + number % 7):
            world.tick()
            rollout = world.centre.rollout
            exposed = {name for name, each in world.robots.items() if each.bundle not in (OLD, *world.centre.proved)}
            assert exposed <= world.centre.exposed.keys()
            if rollout and rollout.assigned:
                assert len(world.centre.exposed) <= allowed(rollout.plan, rollout.at, world.fleet)


MISFORTUNES = st.lists(st.tuples(st.sampled_from(DEEDS), st.integers(0, 100)), min_size=5, max_size=60)


@settings(max_examples=40, deadline=None)
@given(count=st.integers(3, 30), seed=st.integers(0, 10_000), deeds=MISFORTUNES)
def test_never_more_than_the_steps_share_run_what_is_not_proved(
    count: int, seed: int, deeds: list[tuple[str, int]]
) -> None:
    misfortune(count, seed, deeds)


@pytest.mark.soak
@settings(max_examples=3000, deadline=None)
@given(count=st.integers(3, 60), seed=st.integers(0, 1_000_000), deeds=MISFORTUNES)
def test_never_more_whatever_happens_for_long(count: int, seed: int, deeds: list[tuple[str, int]]) -> None:
    misfortune(count, seed, deeds)
