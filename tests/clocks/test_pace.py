"""A clock that can't keep up reports it; processes beside it use the same time."""

from random import Random

import pytest

from lumen.bus import connect
from lumen.bus.memory import MemoryBus
from lumen.bus.validated import validated
from lumen.clock.following import CATCH_UP, SILENCE, FollowingClock
from lumen.clock.simulated import MAX_ARREARS, WINDOW, SimulatedClock
from lumen.language.events import Event
from lumen.robot.recording import RecordingRobot
from lumen.run.compose import compose
from lumen.run.loop import BRAIN_LOST_AFTER, TICK_PERIOD, BehaviorLoop
from lumen.run.node import Node, PaceWatch
from lumen.run.plan import Plan
from lumen.run.presence import Presence
from lumen.run.setup import Setup, set_up_with
from lumen.statechart import Machine
from tests.exhibits import project
from tests.nodes import Printed, whole
from tests.waiting import Collector


class Outside:
    """A clock of the outside world, which advances only if a test advances it."""

    def __init__(self) -> None:
        self.now = 100.0

    def __call__(self) -> float:
        return self.now


class World:
    """A simulated world that needs `slowness` times real time, and can stumble."""

    def __init__(self, outside: Outside, slowness: float = 0.5) -> None:
        self.outside, self.slowness, self.stumble, self.lived = outside, slowness, 0.0, 0.0
        self.clock = SimulatedClock(self.live, 1.0, outside)
        self.clock._bell.sleep = self.sleep  # type: ignore[method-assign]

    def live(self, dt: float) -> None:
        self.lived += dt
        self.outside.now += dt * self.slowness + self.stumble
        self.stumble = 0.0

    def sleep(self, seconds: float) -> None:
        self.outside.now += seconds

    def run(self, seconds: float) -> None:
        until = self.clock.now() + seconds
        while self.clock.now() < until - TICK_PERIOD / 2:
            self.clock.wait(self.clock.now() + TICK_PERIOD)


def test_a_simulation_says_how_much_of_real_time_it_keeps() -> None:
    outside = Outside()
    world = World(outside)
    assert world.clock.realtime == 1.0
    world.run(WINDOW)
    assert world.clock.realtime == pytest.approx(1.0, abs=0.01)
    world.slowness = 1 / 0.85
    world.run(WINDOW)
    assert world.clock.realtime == pytest.approx(0.85, abs=0.01)


def test_ticks_that_the_machine_holds_back_cost_no_time() -> None:
    outside = Outside()
    world = World(outside)
    began, random = outside.now, Random(1)
    for _ in range(500):
        world.stumble = random.choice((0.0, 0.0, 0.0, 0.03))
        world.run(TICK_PERIOD)
    assert world.clock.now() == pytest.approx(outside.now - began, abs=MAX_ARREARS)
    world.stumble = 5.0
    world.run(1.0)
    assert world.clock.now() < outside.now - began - 4.0, "after a long halt nothing is hurried"


def test_slow_time_is_told_once_and_told_again_when_it_is_well() -> None:
    outside = Outside()
    world = World(outside)
    watch, told = PaceWatch(world.clock, outside), []
    for slowness in (0.5, 1 / 0.94, 1 / 0.96, 1 / 0.94, 0.5, 1 / 0.5):
        world.slowness = slowness
        for _ in range(20):
            world.run(1.0)
            told.append(watch.tick())
    lines = [line for line in told if line]
    assert lines[0].startswith("the exhibition is running at only 0.9")
    begun = [line.removeprefix("the exhibition is running ").split()[0] for line in lines]
    assert begun == ["at", "in", "at"]
    assert watch.worst == pytest.approx(0.5, abs=0.02)
    assert watch.summary() == ["at its slowest, the exhibition ran at 0.50 × real time"]
    assert PaceWatch(SimulatedClock(lambda _: None)).summary() == []


def test_an_exhibition_that_is_slow_publishes_that(capsys: pytest.CaptureFixture[str]) -> None:
    exhibit, outside, heard = project(), Outside(), Collector()
    world, robot = World(outside, 1 / 0.8), RecordingRobot(exhibit.body)
    narrator = Printed(world.clock.now, lambda: exhibit.machine)
    exhibition = whole(exhibit, Setup(robot, world.clock, None), narrator=narrator)
    exhibition.node.pace._monotonic = outside
    exhibition.services.bus.subscribe("lumen.state", heard)
    exhibition.start()
    exhibition.run(5.0)
    assert (
        "time     the exhibition is running at only 0.80 × real time: this machine is too slow"
        in capsys.readouterr().out
    )
    assert [body["realtime"] for body in heard.bodies if "realtime" in body] == [0.8]
    assert exhibition.node.summary()[-1] == "at its slowest, the exhibition ran at 0.80 × real time"
    exhibition.close()


LOST = {"seconds": "event.data.seconds", "lost": "context.lost + 1"}


def test_a_behaviour_hears_once_that_its_ticks_stopped() -> None:
    well = {"on": {"brain.lost": {"actions": {"assign": LOST}}}}
    machine = Machine.from_dict({"context": {"lost": 0, "seconds": 0.0}, "states": {"well": well}}, "tour")
    exhibit = project(behaviors={"tour": machine})
    robot = RecordingRobot(exhibit.body)
    clock = SimulatedClock(robot.advance)
    loop = BehaviorLoop(exhibit, robot, MemoryBus(), clock)
    loop.start()
    loop.tick(BRAIN_LOST_AFTER)
    assert loop.runtime.snapshot.context == {"lost": 0, "seconds": 0.0}
    clock.wait(2 * BRAIN_LOST_AFTER + 1.0)
    robot._notice(Event("brain.lost", {"seconds": 9.0}, robot.time))
    loop.tick(clock.now())
    loop.tick(clock.now() + TICK_PERIOD)
    assert loop.runtime.snapshot.context == {"lost": 1, "seconds": BRAIN_LOST_AFTER + 1.0}


@pytest.mark.parametrize(("speed", "pace"), [(1.0, 0.85), (4.0, 0.5), (1.0, 1.02)])
def test_the_clock_of_another_process_follows_the_robots(speed: float, pace: float) -> None:
    """The other process's time differs from the robot's by at most a message's delay, however slow the robot is."""
    outside, random = Outside(), Random(1)
    clock, began, last = FollowingClock(speed, outside), 100.0, 0.0
    offsets = []
    for tick in range(6_000):
        outside.now += TICK_PERIOD
        robots = 7.0 + (outside.now - began) * speed * pace
        if tick % 25 == 0:
            clock.follow("one", robots, outside.now + random.uniform(0.0, 0.005))
        clock.tick()
        assert clock.now() >= last
        last = clock.now()
        if outside.now - began > 20.0:
            offsets.append(clock.now() - robots)
    assert max(offsets) - min(offsets) < 0.03 * speed
    assert clock.realtime == pytest.approx(pace, abs=0.02)


def test_the_processes_of_an_exhibition_live_in_the_robots_time(capsys: pytest.CaptureFixture[str]) -> None:
    """The robot's process publishes the time; all other processes follow it. Only it reports a slow machine."""
    exhibit, outside = project(), Outside()
    robots = World(outside, 1 / 0.8)
    robot = RecordingRobot(exhibit.body)
    hub, clock = validated(connect("memory://"), exhibit), FollowingClock(1.0, outside)
    clock._bell.sleep = lambda seconds: None  # type: ignore[method-assign]
    narrator = Printed(clock.now, lambda: exhibit.machine)
    body = compose(Plan(exhibit, Setup(robot, robots.clock, None), hub, roles=("robot",))).node
    other = Node(exhibit, hub, clock, narrator, presence=Presence(hub, exhibit.robot, (), clock=outside))
    assert body.presence
    assert other.presence
    for presence in (body.presence, other.presence):
        presence._clock = outside
        presence.settle()
    body.pace._monotonic = other.pace._monotonic = outside
    for _ in range(1_000):
        body.tick()
        other.tick()
    assert body.pace.slow
    assert "real time" not in capsys.readouterr().out
    before = clock.now() - robots.clock.now()
    for _ in range(1_000):
        body.tick()
        other.tick()
    assert clock.now() - robots.clock.now() == pytest.approx(before, abs=0.05), "in 20 s of the robot's time"
    other.close()
    body.close()


def test_a_robot_that_was_away_or_is_another_moves_no_time() -> None:
    outside = Outside()
    clock = FollowingClock(1.0, outside)
    for whose, robots in (("one", 50.0), ("one", 50.5), ("two", 0.0), ("two", 0.5)):
        before = clock.now()
        outside.now += 0.5
        clock.follow(whose, robots, outside.now)
        assert clock.now() == pytest.approx(before + 0.5, abs=0.01)
    outside.now += SILENCE + 1.0
    clock.tick()
    assert clock.realtime == 1.0
    before = clock.now()
    clock.follow("two", 0.6, outside.now)
    outside.now += CATCH_UP
    assert clock.now() == pytest.approx(before + CATCH_UP), "nobody waits for what the robot stood still"


def test_somebodys_clock_and_the_world_that_lives_by_it_never_part() -> None:
    outside = Outside()

    class Clock:
        def now(self) -> float:
            return outside.now

        def wait(self, until: float) -> None:
            outside.now = max(outside.now, until)

    class Robot:
        lived = 0.0

        def advance(self, dt: float) -> None:
            self.lived += dt
            outside.now += 0.015  # computing a step needs 15 ms of real time

    robot, began = Robot(), outside.now
    clock = set_up_with(robot, Clock()).clock  # type: ignore[arg-type]
    for _ in range(100):
        clock.wait(clock.now() + TICK_PERIOD)
        outside.now += 0.005  # and so does a tick
    assert robot.lived == pytest.approx(clock.now() - began, abs=2 * TICK_PERIOD)
