"""A run never ends with "All well" after a fall, a dropped event, an error of a `do`, or a missed goal of a joint."""

import json
import re
from collections.abc import Sequence
from datetime import UTC, datetime, timedelta
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

import lumen
from lumen.bus.memory import MemoryBus
from lumen.cli.main import main
from lumen.features.console.entry_words import OTHERS, text_of
from lumen.features.simulation.robot import SimulatedRobot
from lumen.language.commands import Say, Start, Wake
from lumen.language.events import HELD, Event
from lumen.ports import Message, Perform
from lumen.robot.command_reports import CommandRecord, CommandReports
from lumen.robot.person_hold import StoppedBy
from lumen.run.compose import begin
from lumen.run.exhibition import Exhibition
from lumen.run.parts.brain import BrainPart
from lumen.run.parts.remote_brain import RemoteHold
from lumen.run.plan import Plan
from lumen.run.rehearsal import RehearsalTrace, rehearse
from lumen.run.services import Services
from lumen.run.setup import set_up
from lumen.run.trace_publisher import TracePublisher
from lumen.run.trace_subscriber import TraceSubscriber
from lumen.run.troubles import RunTrouble
from lumen.statechart import Step
from tests import exhibits
from tests.tables import for_each
from tests.waiting import HANG, Collector, until

INPUTS = Path(__file__).parent / "inputs" / "runs"
TOUCH = "title: A hand\nsteps:\n" + "  - touch: MiddleTactil\n  - wait: 1s\n" * 5
WAIT = "title: Nobody\nsteps:\n  - wait: 20s\n"
QUICK = "initial: over\nstates: {over: {type: final}}\n"
FAILS = """\
context: {n: 0}
initial: a
states:
  a: {do: {say: "{{ 1 / context.n }}"}, onDone: b, onError: b}
  b: {on: {touched: a}}
  c: {on: {touched: a}}
"""
HASTY = "keyframes: [{at: 450ms, joints: {HeadYaw: 1.9}}]\n"
"""The time is long enough if the head starts as in `Stand`."""
HASTY_PLAYED = """\
initial: a
states:
  a: {do: [{look: {yaw: -1.9, pitch: 0}}, {play: hasty}], onDone: b}
  b: {on: {touched: a}}
"""
FAILING_TIMER = """\
context: {n: 0}
initial: a
states:
  a: {after: {5s: b}}
  b: {always: {guard: context.n == 0, target: c}}
  c: {always: {guard: context.n == 0, target: b}}
"""


@pytest.fixture(autouse=True)
def wide(monkeypatch: pytest.MonkeyPatch) -> None:
    """Print each line whole."""
    monkeypatch.setenv("COLUMNS", "300")


def exhibition(folder: Path, behavior: str, story: str, **files: str) -> str:
    """Write a minimal project with this behaviour, the story `visitor`, and further behaviours and motions."""
    root = folder / "show"
    assert main(["new", str(root), "--minimal"]) == 0
    (root / "behaviors" / "hello.yaml").write_text(behavior, "utf-8")
    (root / "behaviors" / "stories" / "visitor.yaml").write_text(story, "utf-8")
    for name, text in files.items():
        where = root / ("motions" if text.startswith("keyframes:") else "behaviors")
        where.mkdir(exist_ok=True)
        (where / f"{name}.yaml").write_text(text, "utf-8")
    return str(root)


def read(name: str) -> str:
    return (INPUTS / name).read_text("utf-8")


def run(root: str, *arguments: str, robot: str = "recording") -> int:
    return main(["run", root, "--speed", "max", "--robot", robot, *arguments])


@for_each("name", ["endless-guarded.yaml", "endless-invoke.yaml"])
@pytest.mark.process
def test_a_story_in_which_an_event_is_dropped_fails(
    name: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    root = exhibition(tmp_path, read(name), TOUCH, quick=QUICK)
    assert run(root, "--story", "visitor") == 1
    told = capsys.readouterr().out
    assert "The story failed" in told
    assert "the event `touched` is dropped: `hello` never comes to rest" in told
    assert rehearse(lumen.load(root), lumen.load(root).stories["visitor"]).failed


@pytest.mark.network
def test_a_run_in_which_a_timer_is_dropped_ends_with_trouble(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    root = exhibition(tmp_path, FAILING_TIMER, WAIT)
    assert run(root, "--for", "10s", "--format", "json") == 1
    verdict = json.loads(next(line for line in capsys.readouterr().out.splitlines() if line.startswith("{")))
    assert verdict["ended"] == "troubled"
    assert verdict["failure"].startswith("the timer `after.5s.")
    assert run(root, "--story", "visitor") == 1
    assert "the timer `after.5s." in capsys.readouterr().out


@for_each(
    ("behavior", "story", "code"),
    [
        (FAILS, "steps: [{wait: 10s}]", 1),
        (FAILS, "steps: [{expect: {state: b}}]", 1),  # `b` also follows a successful `do`
        (FAILS.replace("onError: b", "onError: c"), "steps: [{expect: {state: c}}]", 0),
        (FAILS.replace("onError: b", "onError: c"), "steps: [{wait: 10s}]", 1),
        (FAILS.replace(", onError: b", ""), "steps: [{wait: 10s}]", 1),
        (FAILS, "robot: {say: fails}\nsteps: [{expect: {state: b}}]", 0),
    ],
)
@pytest.mark.network
def test_an_error_that_ended_a_do_fails_a_story_that_does_not_expect_it(
    behavior: str, story: str, code: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    root = exhibition(tmp_path, behavior, f"title: Broken\n{story}\n")
    assert run(root, "--story", "visitor") == code
    told = capsys.readouterr().out
    assert ("All well" in told) == (code == 0)
    assert re.search(r"^[A-Z][a-z ]+: 0:\d\d of simulated time in \d+ s \(\d+\.\d × real time\)\.$", told, re.MULTILINE)
    assert ("an error ended the `do` of `a`: " in told) == (code == 1)
    project = lumen.load(root)
    assert (rehearse(project, project.stories["visitor"]).failed is not None) == (code == 1)


@for_each(
    ("behavior", "code"),
    [
        ('initial: a\nstates: {a: {entry: {say: "{{ 1 / 0 }}"}}}\n', 1),
        ('initial: a\nstates: {a: {entry: {say: "{{ 1 / 1 }}"}}}\n', 0),
        ("context: {n: 0}\ninitial: a\nstates: {a: {on: {touched: {actions: {assign: {n: 1 / context.n}}}}}}\n", 1),
    ],
)
@pytest.mark.network
def test_after_a_failed_action_a_run_does_not_end_well(
    behavior: str, code: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """This holds for an action outside of a `do`, too: in an `entry` or a transition."""
    root = exhibition(tmp_path, behavior, TOUCH)
    assert run(root, "--story", "visitor") == code
    told = capsys.readouterr().out
    assert ("All well" in told) == (code == 0)
    assert ("an action failed: this divides by zero" in told) == (code == 1)


@pytest.mark.network
def test_an_error_in_an_invoked_behaviour_is_named_with_its_way(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    behavior = "initial: m\nstates: {m: {invoke: {behavior: inner, id: quiz}}}\n"
    root = exhibition(tmp_path, behavior, WAIT, inner=FAILS)
    assert run(root, "--story", "visitor") == 1
    assert "an error ended the `do` of `quiz/a`: " in capsys.readouterr().out


@pytest.mark.physics
def test_after_a_fall_a_run_does_not_end_well(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    root = exhibition(tmp_path, read("walk-over-the-edge.yaml"), WAIT)
    assert run(root, "--story", "visitor", robot="simulation") == 1
    assert "expected the robot to stay on its feet, but it fell" in capsys.readouterr().out
    assert run(root, "--for", "15s", robot="simulation") == 1
    told = capsys.readouterr().out
    assert "Ended with trouble: 0:15" in told
    assert "  the robot fell\n  an error ended the `do` of `a`: the robot fell\n" in told
    assert "All well" not in told


@pytest.mark.physics
def test_a_motion_that_begins_too_far_away_gets_its_time_and_one_too_fast_in_itself_misses_its_goal(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    root = exhibition(tmp_path, HASTY_PLAYED, "title: Haste\nsteps: [{expect: {state: b}}]\n", hasty=HASTY)
    assert run(root, "--story", "visitor", robot="simulation") == 0
    told = capsys.readouterr().out
    assert "plays hasty" in told
    assert "missed its goal" not in told
    too_fast = tmp_path / "nod.motion"
    too_fast.write_text("#WEBOTS_MOTION,V1.0,HeadYaw\n00:00:100,Pose,2.0\n00:00:300,Pose,-2.0\n", "utf-8")
    assert main(["play", str(too_fast), "--project", root]) == 1
    assert "in `nod` a joint missed its goal: `HeadYaw` was " in capsys.readouterr().err
    assert main(["play", "wave", "--project", root]) == 0


@pytest.mark.physics
@for_each(("limp", "missed"), [((), False), (("RShoulderPitch",), True)])
def test_a_joint_without_stiffness_misses_its_goal(limp: tuple[str, ...], missed: bool) -> None:
    """The hanging arm is at the last goal of the motion, but missed the goals before."""
    project = lumen.load(".")
    robot = set_up("simulation", project, "max").robot
    assert isinstance(robot, SimulatedRobot)
    robot.motors.stiffen(0.0, limp)
    robot.start("p", Perform(project.motions["goodbye"]))
    ended: list[Event] = []
    while not ended:
        robot.advance(0.02)
        ended = [event for event in robot.poll() if event.name == "done.command.p"]
    assert ("`RShoulderPitch` was" in str(ended[0].data)) == missed
    robot.close()


def test_a_remote_robots_missed_goal_is_in_its_report() -> None:
    told: list[dict[str, Any]] = []
    reports = CommandReports(told.append, lambda _message, _body: None)
    reports.accept(CommandRecord(Message("", None), "b.c1", at="m1"))
    reports.answered("done", "m1", "`HeadYaw` was 1.7 rad away")
    assert told[-1] == {"id": "b.c1", "state": "finished", "method": "", "reason": "`HeadYaw` was 1.7 rad away"}


def test_a_story_in_its_own_process_receives_troubles() -> None:
    bus, project = MemoryBus(), exhibits.project()
    heard: list[RunTrouble] = []
    subscriber = TraceSubscriber(project, bus, lambda _event: None)
    subscriber.watchers.append(SimpleNamespace(troubled=heard.append))
    trouble = RunTrouble("dropped", "the event `touched` is dropped: it never comes to rest")
    TracePublisher(bus, lambda: project, lambda: 1.0).troubled(trouble)

    def told() -> bool:
        subscriber.tick(1.0)
        return bool(heard)

    until(told, HANG)
    assert heard == [trouble]


def test_the_requests_of_a_story_in_its_own_process_name_who_makes_them() -> None:
    bus, project, asked = MemoryBus(), exhibits.project(), Collector()
    bus.subscribe("lumen.NAO.operator.request", asked)
    subscriber = TraceSubscriber(project, bus, lambda _event: None)
    assert subscriber.press("Dance", "a story") == subscriber.approve("a story", go=True) == ""
    subscriber.set_autonomy("ask", "a story")
    assert asked.bodies == [
        {"ask": "press", "button": "Dance", "by": "a story"},
        {"ask": "approve", "id": "", "go": True, "by": "a story"},
        {"ask": "autonomy", "level": "ask", "by": "a story"},
    ]


WAKES = "initial: a\nentry: {wake: true}\nstates: {a: {do: [{posture: Stand}], on: {stop: b}}, b: {}}\n"


def test_a_command_that_a_stopped_robot_refuses_is_reported_as_refused(tmp_path: Path) -> None:
    """After a person's stop and a restart, no refused command is reported as performed."""
    project = lumen.load(exhibition(tmp_path, WAKES, WAIT))
    setup = set_up("recording", project, "max")
    trace = RehearsalTrace(setup.clock.now, lambda: project.machine, None)
    show = Exhibition(Plan(project, setup, narrator=trace))
    told: list[dict[str, Any]] = []
    show.node.bus.subscribe(project.key_of("state"), lambda message: told.append(message.body))
    with show:
        show.robot.server.hold.stop("Ada")
        show.start()
        for _ in range(5):
            show.tick()
        lines = [(who, text) for _, who, text in trace.lines]
        reason = "Ada stopped the robot: hold its head, or run `lumen resume`"
        assert ("refused", f"wake: {reason}") in lines
        assert ("refused", f"go into the posture Stand: {reason}") in lines
        assert not [text for who, text in lines if who == "robot"]
        assert ("state", "b  (stop)") in lines
        assert trace.troubles == []
        chain = show.why("c1")["chain"]
        assert chain[0]["text"] == f"wakes (refused: {reason})"
        until(lambda: [body for body in told if "b" in body.get("entered", ())], HANG)
    assert [body["refused"]["verb"] for body in told if "refused" in body] == ["wake", "posture"]
    assert not [body for body in told if "command" in body]


@pytest.mark.network
def test_a_stopped_robot_prints_its_commands_as_refused_after_a_restart(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """The previous run was killed 11 minutes ago; a walk to a place is refused like a posture."""
    root = exhibition(tmp_path, WAKES.replace("{posture: Stand}", "{walk: {to: desk}}"), WAIT)
    settings = Path(root, "lumen.yaml")
    settings.write_text(settings.read_text("utf-8") + "places: {desk: {x: 1, y: 0, heading: 0}}\n", "utf-8")
    home = Path(root, ".lumen")
    home.mkdir()
    since = datetime.now(UTC) - timedelta(minutes=11)
    (home / "stopped.json").write_text(json.dumps({"by": "Ada", "since": since.isoformat()}), "utf-8")
    capsys.readouterr()
    assert run(root, "--for", "5s") == 0
    told = [line.split(maxsplit=1)[1] for line in capsys.readouterr().out.splitlines() if line.startswith(" 0:0")]
    reason = f"Ada stopped the robot: {HELD}"
    assert f"refused  wake: {reason}" in told
    assert f"refused  walk to desk: {reason}" in told
    assert not [line for line in told if line.startswith("robot")]


def test_a_brain_prints_what_a_remote_robot_refuses_as_refused() -> None:
    since = datetime(2026, 11, 26, tzinfo=UTC)
    stopped: list[StoppedBy] = [StoppedBy("Ada", since)]
    hold = RemoteHold(lambda: stopped[0] if stopped else None)
    reason = f"Ada stopped the robot: {HELD}"
    assert hold.refuse(Wake()) == reason
    assert hold.refuse(Say("Hello")) == ""
    for let, lets in [
        (Event("touched", {"sensor": "LHand"}), False),
        (Event("touched", {"sensor": "FrontTactil"}), True),
        (Event("stop", {"by": "Bo"}), False),
        (Event("resume", {"by": "Bo"}), True),  # the robot's process may publish the stop for another second
    ]:
        hold.answered(let)
        assert (hold.refuse(Wake()) == "") == lets, let
    hold.answered(Event("stop", {"by": "Bo"}))
    stopped.clear()
    assert hold.refuse(Wake()) == ""


def test_a_refusal_that_the_brain_did_not_foresee_is_reported() -> None:
    project = exhibits.project()
    trace = RehearsalTrace(lambda: 1.0, lambda: project.machine, None)
    trace.performing(Start("c1", Wake()), 1.0)
    trace.answered(Event("error.command.c1", {"reason": f"Ada stopped the robot: {HELD}"}))
    assert [(who, text) for _, who, text in trace.lines] == [
        ("robot", "wakes"),
        ("refused", f"wake: Ada stopped the robot: {HELD}"),
    ]


def test_a_run_that_a_person_ends_has_no_trouble(tmp_path: Path) -> None:
    project = lumen.load(exhibition(tmp_path, WAKES, WAIT))
    show = Exhibition(Plan(project, set_up("recording", project, "max")))
    with show:
        show.start()
        show.tick()
        show.stop()
        show.run(1.0)
        assert "b" in show.configuration
        assert show.node.troubles == []


def test_the_console_shows_a_refusal() -> None:
    entry = {"heard": "error.command.c1", "data": {"reason": f"Ada stopped the robot: {HELD}"}}
    assert text_of(entry) == f"refused: Ada stopped the robot: {HELD}"
    assert text_of(entry, OTHERS["id"]).startswith("ditolak: Ada")
    assert text_of({**entry, "data": {"reason": "the robot fell"}}) == "error.command.c1: the robot fell"


STOPPED = """\
initial: a
on: {stop: .s}
states:
  a: {do: [{wake: true}, {wait: 5s}], onDone: a, onError: failed}
  failed: {}
  s: {}
"""


@pytest.mark.network
def test_a_stop_comes_before_what_it_cancels_and_is_no_trouble(tmp_path: Path) -> None:
    root = exhibition(tmp_path, STOPPED, WAIT)
    steps = list[Step]()
    with lumen.open(root, robot="recording") as show:
        show.observe(steps.append)
        show.stop()
        show.run(0.5)
        assert "s" in show.configuration
    assert not any("failed" in step.entered for step in steps)


@pytest.mark.network
def test_a_run_that_a_person_stopped_says_so_at_its_end(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    root = exhibition(tmp_path, STOPPED, WAIT)

    def stopped(shows: Sequence[Services]) -> None:
        begin(shows)
        shows[0][BrainPart].rest("ada on stand")

    monkeypatch.setattr("lumen.cli.run.begin", stopped)
    assert run(root, "--for", "1s") == 0
    told = capsys.readouterr().out
    assert "\nStopped by ada on stand: 0:01 of simulated time" in told
    assert "All well" not in told
    assert "error.do" not in told
