"""A running exhibition under other files: the head, a motion, messages under way, the language."""

import threading
from dataclasses import replace

import pytest

from lumen.bus.memory import MemoryBus
from lumen.clock.simulated import SimulatedClock
from lumen.features.simulation.offers import SimulatedRobot
from lumen.insight.migration import MigrationDelay, MigrationPlan
from lumen.language.events import Event
from lumen.language.machines import MachineDefinition
from lumen.language.motions import MotionDefinition
from lumen.language.projects import Project
from lumen.language.routes import Direction, Route
from lumen.language.stories import Visitor
from lumen.project import load
from lumen.robot.recording import RecordingRobot
from lumen.run.approvals import Approvals
from lumen.run.loop import TICK_PERIOD, BehaviorLoop, Observer
from lumen.run.setup import Setup
from lumen.statechart import Machine, Snapshot, Step
from tests import ROOT, exhibits
from tests.nodes import whole
from tests.tables import for_each
from tests.waiting import until


class Seen(Observer):
    """Keeps the names of all events that the behaviour took, and the times of the robot's answers."""

    def __init__(self) -> None:
        self.events: list[str] = []
        self.answers: list[tuple[str, float]] = []

    def stepped(self, step: Step) -> None:
        if step.event:
            self.events.append(step.event.name)

    def answered(self, event: Event) -> None:
        self.answers.append((event.name, event.at))


def machine(**parts: object) -> Machine:
    return Machine.from_dict({"id": "tour", **parts}, "tour")


def running(project: Project) -> tuple[BehaviorLoop, Seen]:
    robot, seen = RecordingRobot(project.body), Seen()
    exhibition = BehaviorLoop(project, robot, MemoryBus(), SimulatedClock(robot.advance))
    exhibition.observers.append(seen)
    exhibition.start()
    return exhibition, seen


def swap(exhibition: BehaviorLoop, project: Project, **how: bool) -> MigrationPlan:
    plan = exhibition.plan(project, **how)
    assert isinstance(plan, MigrationPlan)
    exhibition.apply(project, plan)
    return plan


def test_the_head_goes_on_smoothly_under_another_controller() -> None:
    project = load(ROOT)
    robot = SimulatedRobot(project.body, ROOT / "models", project.hall)
    show = whole(project, Setup(robot, SimulatedClock(robot.advance), robot))
    show.start()
    assert show.visitor
    show.visitor.arrive(Visitor(1.2, 0.8))
    head = {name: robot.motors.index[name] for name in ("HeadYaw", "HeadPitch")}
    quick = replace(project.controllers["head"].tracking, speed=0.9, looks=1)
    bindings = tuple(replace(b, gain=-b.gain) for b in project.controllers["head"].output_bindings)
    wild = replace(project.controllers["head"], tracking=quick, output_bindings=bindings)
    before = {name: float(robot.motors.goal[i]) for name, i in head.items()}
    moved = dict.fromkeys(head, 0.0)
    for tick in range(130):
        if tick == 65:
            assert moved["HeadYaw"] > 0.1  # it follows the visitor
            moved = dict.fromkeys(head, 0.0)
            changed = replace(project, controllers={**project.controllers, "head": wild})
            plan = show.behavior.plan(changed)
            assert isinstance(plan, MigrationPlan)
            show.behavior.apply(changed, plan)
        show.tick()
        for name, i in head.items():
            goal = float(robot.motors.goal[i])
            assert abs(goal - before[name]) <= project.body.joints[name].speed * TICK_PERIOD + 1e-9
            moved[name] += abs(goal - before[name])
            before[name] = goal
    assert moved["HeadYaw"] > 0.1  # so it does under the other one
    show.close()


DANCING = machine(states={"a": {"do": {"play": "dance"}, "onDone": "b"}, "b": {"do": {"play": "dance"}}})


def test_a_motion_that_plays_ends_as_it_began_and_is_the_new_one_the_next_time() -> None:
    project = exhibits.project(behaviors={"tour": DANCING})
    exhibition, seen = running(project)
    exhibition.tick()
    longer = {**project.motions, "dance": MotionDefinition("dance", 3.0, project.motions["dance"].tracks)}
    swap(exhibition, replace(project, motions=longer))
    until(lambda: len(seen.answers) >= 2, meanwhile=exhibition.tick)
    (first, at), (second, later) = seen.answers
    assert (first, second) == ("done.command.d1", "done.command.d2")
    assert abs(at - 1.0) < 2 * TICK_PERIOD
    assert abs(later - at - 3.0) < 2 * TICK_PERIOD


def test_a_motion_that_plays_may_be_deleted_when_it_has_ended() -> None:
    project = exhibits.project(behaviors={"tour": DANCING})
    exhibition, seen = running(project)
    calm = machine(states={"a": {"do": {"say": "no"}, "onDone": "b"}, "b": {}})
    without = replace(project, behaviors={"tour": calm}, motions={})
    assert exhibition.plan(without) == MigrationDelay("these files change the `do` of `a`, which is still running", "a")
    until(lambda: len(seen.answers) >= 2, meanwhile=exhibition.tick)
    exhibition.tick()
    assert swap(exhibition, without).commands == ()


def test_cancelled_rather_than_waited_for_it_begins_what_is_new() -> None:
    project = exhibits.project(behaviors={"tour": DANCING})
    exhibition, seen = running(project)
    exhibition.tick()
    singing = machine(states={"a": {"do": {"play": "sing"}, "onDone": "b"}, "b": {}})
    swap(exhibition, replace(project, behaviors={"tour": singing}), now=True)
    until(lambda: "b" in exhibition.runtime.snapshot.configuration, meanwhile=exhibition.tick)
    assert [name for name, _ in seen.answers] == ["cancelled.command.d1", "done.command.d2"]


def test_no_message_is_lost_while_routes_come_and_go() -> None:
    listening = machine(events={"face": {}}, states={"a": {"on": {"*": {"actions": {"log": "x"}}}}})
    project = exhibits.project(behaviors={"tour": listening})
    exhibition, seen = running(project)
    other = Route("other", "lumen.other", Direction.IN, event="other")
    face = replace(project.routes["face"], ttl=3.0)
    variants = [
        replace(project, routes={**project.routes, "other": other}),
        replace(project, routes={**project.routes, "face": face}),
        project,
    ]
    turns, each = 40, 50
    go = threading.Semaphore(0)

    def publish() -> None:
        for _ in range(turns):
            go.acquire()
            for _ in range(each):
                exhibition.bus.publish("lumen.visual.face.detection", {"x": 0.0, "y": 0.0})

    publisher = threading.Thread(target=publish)
    publisher.start()
    for turn in range(turns):
        go.release()
        swap(exhibition, variants[turn % 3])  # while it publishes
        exhibition.tick()
    publisher.join()
    exhibition.tick()
    assert seen.events.count("face") == turns * each


@pytest.mark.parametrize("part", ["approvals", "recorder"])
def test_where_going_on_with_other_files_fails_all_is_as_before(part: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """The fault is in Lumen itself, in the last step of the reload."""
    project = exhibits.project(behaviors={"tour": DANCING})
    exhibition, _ = running(project)
    runtime, other = exhibition.runtime, replace(project, languages=("nl", "en"))
    stood, plan = runtime.snapshot, exhibition.plan(other)
    assert isinstance(plan, MigrationPlan)
    with monkeypatch.context() as patched:
        patched.setattr(runtime, part, Faulty(runtime.approvals))
        with pytest.raises(ZeroDivisionError):
            exhibition.apply(other, plan)
    assert runtime.project is project
    assert runtime.snapshot is stood
    exhibition.apply(other, plan)
    assert runtime.project is other


class Faulty:
    """Approvals, or a recorder, that fail once."""

    def __init__(self, approvals: Approvals) -> None:
        self._approvals, self._fails = approvals, True

    def use(self, machine: MachineDefinition, snapshot: Snapshot) -> None:
        self._fail()
        self._approvals.use(machine, snapshot)

    def jumped(self, *_: object, **__: object) -> None:
        self._fail()

    def _fail(self) -> None:
        if self._fails:
            self._fails = False
            raise ZeroDivisionError


def test_a_language_that_is_gone_is_no_longer_spoken() -> None:
    project = exhibits.project(behaviors={"tour": DANCING})
    exhibition, _ = running(project)
    exhibition.runtime.apply(project, exhibition.runtime.snapshot._replace(language="id"))
    plan = swap(exhibition, replace(project, languages=("nl", "en")))
    assert plan.notes == ("language `id` was removed: the behaviour continues in `nl`",)
    assert exhibition.runtime.snapshot.language == "nl"
    assert swap(exhibition, replace(project, languages=("en", "nl"))).notes == ()
    assert exhibition.runtime.snapshot.language == "nl"


POINTS = ("situation.place", "situation.can_continue", "carried_state.context", "carried_state.timers",
          "carried_state.history", "migrating.microstep", "migrating.complete")  # fmt: skip


@for_each("point", POINTS)
def test_a_fault_anywhere_in_a_plan_changes_nothing(point: str, monkeypatch: pytest.MonkeyPatch) -> None:
    project = exhibits.project(behaviors={"tour": DANCING})
    exhibition, seen = running(project)
    before = exhibition.runtime.snapshot
    more = machine(
        context={"more": 1}, states={"a": {"do": {"play": "dance"}, "onDone": "b"}, "b": {"do": {"play": "dance"}}}
    )
    changed = replace(project, behaviors={"tour": more})
    with monkeypatch.context() as patched:
        patched.setattr(f"lumen.insight.migration.{point}", fault)
        with pytest.raises(ZeroDivisionError):
            exhibition.plan(changed)
    assert exhibition.project is project
    assert exhibition.runtime.snapshot is before
    until(lambda: seen.answers, meanwhile=exhibition.tick)
    assert swap(exhibition, changed).snapshot.context == {"more": 1}


def fault(*_: object, **__: object) -> None:
    raise ZeroDivisionError
