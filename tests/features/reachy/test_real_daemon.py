"""Reachy Mini's adapter on the real daemon (`reachy-mini` of PyPI), which has no robot: mock-up and physics."""

import json
from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest

import lumen
from lumen.clock.real import RealClock
from lumen.features.reachy.pose import BODY
from lumen.features.reachy.robot import ReachyRobot
from lumen.language.commands import Look, Posture, Rest, Stop, Wake
from lumen.language.projects import Project
from lumen.ports import Aim, Live, Perform
from tests import ROOT
from tests.copying import copied_project
from tests.features.reachy.driving import Driven
from tests.features.reachy.protocol import RECORDED, observed
from tests.features.reachy.real_daemon import RealDaemon, program
from tests.waiting import until

pytestmark = [
    pytest.mark.xdist_group("reachy daemon"),
    pytest.mark.rest,
    pytest.mark.process,
    pytest.mark.usefixtures("patient"),
]


@pytest.fixture(scope="module")
def daemon(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RealDaemon]:
    program()
    one = RealDaemon(tmp_path_factory.mktemp("reachy"))
    yield one
    one.close()


@pytest.fixture
def robot(project: Project, daemon: RealDaemon) -> Iterator[Driven]:
    """A robot that is awake, and sleeps when the test ends."""
    one = Driven(project, daemon.url)
    assert one.answer("wake", Wake()).name == "done.command.wake"
    yield one
    one.answer("rest", Rest())
    one.until(lambda: daemon.api.request("GET", "/api/move/running") == [], "it lies")
    one.close()


def turned(robot: Driven) -> float:
    """Return how far the head is turned to the left [rad]."""
    return robot.joints()["head_yaw"]


def test_it_answers_as_it_was_recorded(daemon: RealDaemon) -> None:
    """The pose that ends a move may be the last but one on a slow machine, some hundredths of a radian away."""
    found, recorded = observed(daemon.url), json.loads(RECORDED.read_text())
    for name in ("awake", "asleep"):
        one, other = found.pop(name), recorded.pop(name)
        assert one["pose"] == pytest.approx(other["pose"], abs=0.05)
        assert one["antennas"] == pytest.approx(other["antennas"], abs=0.05)
        assert one["mode"] == other["mode"]
    assert found == recorded


def test_it_keeps_the_promises_of_a_robot(robot: Driven, project: Project) -> None:
    robot.robot.start("", Live(project.life["lively"]))
    assert robot.answer("l", Look(0.5, 0.2)).name == "done.command.l"
    robot.until(lambda: turned(robot) == pytest.approx(0.5, abs=0.06), "the head has turned")
    assert robot.answer("far", Look(2.4, 0.0)).name == "done.command.far"
    robot.until(lambda: abs(turned(robot) - robot.joints()[BODY]) < 1.0, "the trunk has turned as well")
    assert robot.answer("p", Posture("Curious")).name == "done.command.p"
    assert robot.answer("n", Perform(project.motions["nod"])).name == "done.command.n"
    robot.robot.start("", Live(project.life["calm"]))
    robot.robot.start("", Aim({"head_yaw": -0.4, "head_pitch": 0.1}, 0.5))
    robot.until(lambda: abs(turned(robot) + 0.4) < 0.1, "the head has turned")


def test_every_shipped_motion_is_reached(robot: Driven, project: Project) -> None:
    """The daemon holds the last pose that it reached, without an error: the head is compared with its goals.

    A head that follows late meets each goal later; half of the goals must be met, as the head may pass others between
    two readings.
    """
    for name in ("greet", "curious", "goodbye"):
        robot.robot.start(name, Perform(project.motions[name]))
        goals, readings = [], []
        while not robot._answered(name):
            robot.tick()
            goals.append(dict(robot.robot._mover.sent))
            readings.append(robot.joints())
        assert robot._answered(name)[0].data is None
        robot.until(lambda: far(goals[-1], robot.joints()) < 0.1, f"the end of {name}")  # noqa: B023 - called here
        readings.append(robot.joints())
        met = [any(far(goal, reading) < 0.1 for reading in readings[i:]) for i, goal in enumerate(goals)]
        assert sum(met) > len(met) / 2, name


def far(goal: Mapping[str, float], reading: Mapping[str, float]) -> float:
    """Return the greatest distance of a joint of the head from its goal [rad or m]."""
    return max(abs(goal[joint] - angle) for joint, angle in reading.items() if "head" in joint)


def test_a_stop_ends_a_dance(robot: Driven, project: Project) -> None:
    robot.robot.start("d", Perform(project.motions["dance"]))
    robot.until(lambda: abs(robot.joints()["head_roll"]) > 0.1, "it dances")
    assert robot.answer("s", Stop("play")).name == "done.command.s"
    assert "cancelled.command.d" in robot.names()


def test_a_second_program_is_noticed(robot: Driven, daemon: RealDaemon, project: Project) -> None:
    robot.robot.start("", Live(project.life["lively"]))
    robot.robot.start("d", Perform(project.motions["dance"]))
    robot.tick()
    body = {"head_pose": {"yaw": 0.8}, "duration": 3.0}
    daemon.api.request("POST", "/api/move/goto", body)
    assert "another program moves the robot" in robot.answer("d").data["reason"]
    robot.until(lambda: daemon.api.request("GET", "/api/move/running") == [], "that move has ended")
    robot.until(lambda: not robot.robot._yields, "Lumen goes on")
    assert robot.answer("l", Look(0.1)).name == "done.command.l"


def test_a_daemon_killed_in_a_dance_comes_back_awake(tmp_path: Path, project: Project) -> None:
    program()
    daemon = RealDaemon(tmp_path)
    robot = Driven(project, daemon.url)
    robot.answer("wake", Wake())
    robot.robot.start("d", Perform(project.motions["dance"]))
    robot.until(lambda: abs(robot.joints()["head_roll"]) > 0.1, "it dances")
    daemon.kill()
    robot.until(lambda: "robot.lost" in robot.names(), "it is lost")
    assert robot.answer("d").name == "error.command.d"
    daemon.start()
    robot.until(lambda: "robot.back" in robot.names(), "it is back")
    assert robot.answer("l", Look(0.3)).name == "done.command.l"
    robot.close()
    daemon.close()


def test_two_robots(tmp_path: Path, project: Project, robot: Driven) -> None:
    second = RealDaemon(tmp_path)
    other = Driven(project, second.url)
    other.answer("w", Wake())
    robot.answer("l", Look(0.5))
    other.answer("l", Look(-0.5))
    for each, angle in ((robot, 0.5), (other, -0.5)):
        each.until(lambda each=each, angle=angle: turned(each) == pytest.approx(angle, abs=0.06), f"it is at {angle}")
    other.close()
    second.close()


def test_the_host_greets_dances_and_says_goodbye(daemon: RealDaemon, tmp_path: Path) -> None:
    """The example on the daemon, from the face of a visitor to the goodbye."""
    folder = copied_project(ROOT / "examples/reachy", tmp_path / "host")
    project = lumen.load(folder)
    clock = RealClock()
    robot = ReachyRobot(project.body, daemon.url, clock.now)
    entered: list[str] = []
    with lumen.open(folder, robot=robot, clock=clock) as exhibition:
        exhibition.observe(lambda step: entered.extend(step.entered))

        def until_entered(*states: str) -> None:
            """Run until these states were entered, one after the other."""
            for state in states:
                until(
                    lambda state=state: state in entered,
                    meanwhile=lambda: exhibition.run(seconds=0.2),
                    what=state,
                    shown=lambda: entered,
                )
                del entered[: entered.index(state) + 1]

        until(lambda: "waiting" in exhibition.configuration, meanwhile=lambda: exhibition.run(seconds=0.2))
        exhibition.send("face", {"x": 160.0, "y": 120.0})
        until_entered("here.greeting", "listening")
        exhibition.send("heard", {"name": "visitor", "result": "dance", "date": "", "language": "en"})
        until_entered("here.dancing", "listening")
        exhibition.send("heard", {"name": "visitor", "result": "Goodbye!", "date": "", "language": "en"})
        until_entered("here.goodbye", "waiting")


@pytest.mark.slow
def test_it_moves_under_physics(tmp_path: Path, project: Project) -> None:
    program()
    daemon = RealDaemon(tmp_path, "--sim")
    robot = Driven(project, daemon.url)
    assert robot.answer("w", Wake()).name == "done.command.w"
    assert robot.answer("l", Look(0.5, 0.2)).name == "done.command.l"
    assert robot.answer("n", Perform(project.motions["nod"])).name == "done.command.n"
    assert robot.answer("r", Rest()).name == "done.command.r"
    robot.close()
    daemon.close()
