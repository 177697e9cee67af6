"""Reachy Mini's adapter keeps the promises of a robot, on a fake of its daemon."""

import time
from math import nan, radians
from pathlib import Path

import pytest

from lumen.errors import RobotError, RobotModelError, UsageError
from lumen.features.reachy import skills
from lumen.features.reachy.daemon_api import DaemonAddress
from lumen.features.reachy.pose import BODY, JOINTS
from lumen.features.reachy.robot import ReachyRobot
from lumen.language.commands import Leds, Look, PlaySound, Posture, Rest, Say, Stop, Volume, Wake, Walk
from lumen.language.projects import Project
from lumen.ports import Aim, Joints, Live, Perform, Record, RobotCommand, Sense
from tests import exhibits
from tests.features.reachy.driving import Driven
from tests.features.reachy.fake import ASLEEP, INIT, FakeDaemon
from tests.tables import for_each

pytestmark = pytest.mark.usefixtures("patient")


def data(robot: Driven, id: str, command: RobotCommand) -> str:
    """Return the reason why a command fails."""
    event = robot.answer(id, command)
    assert event.name == f"error.command.{id}"
    return str(event.data["reason"])


@pytest.mark.once
def test_it_wakes_looks_plays_and_sleeps(robot: Driven, daemon: FakeDaemon, project: Project) -> None:
    assert robot.answer("w", Wake()).name == "done.command.w"
    assert daemon.joints == pytest.approx(INIT, abs=0.01)
    robot.robot.start("", Live(project.life["lively"]))
    assert robot.answer("l", Look(0.5, 0.2)).name == "done.command.l"
    assert robot.answer("p", Perform(project.motions["nod"])).name == "done.command.p"
    assert robot.answer("s", Posture("Curious")).name == "done.command.s"
    assert robot.answer("r", Rest()).name == "done.command.r"
    robot.until(lambda: not daemon.moves, "it lies")
    assert daemon.joints == pytest.approx(ASLEEP, abs=0.01)
    assert daemon.mode == "disabled"


def test_nothing_is_sent_before_it_was_woken_and_after_it_sleeps(robot: Driven, daemon: FakeDaemon) -> None:
    assert "`wake` first" in data(robot, "l", Look(0.3))
    assert "`wake` first" in data(robot, "p", Posture("Stand"))
    robot.robot.start("", Aim({"head_yaw": 0.4}))
    robot.tick()
    assert not daemon.targets
    robot.answer("w", Wake())
    robot.answer("r", Rest())
    sent = len(robot.sent)
    robot.robot.start("", Aim({"head_yaw": 0.4}))
    robot.until(lambda: not daemon.moves, "it lies")
    assert len(robot.sent) == sent
    assert robot.answer("again", Wake()).name == "done.command.again"


def test_a_robot_that_is_awake_when_lumen_comes_needs_no_waking(daemon: FakeDaemon, project: Project) -> None:
    daemon.joints = dict(INIT)
    robot = Driven(project, daemon.url)
    assert robot.answer("l", Look(0.3, 0.1)).name == "done.command.l"
    robot.close()


@for_each(
    ("command", "words"),
    [
        (Leds({"eyes": "red"}), "has no lights"),
        (Walk(0.2), "neither legs nor wheels"),
        (Record("r", 1.0), "records nothing"),
        (Posture("Handstand"), "Handstand"),
        (Look(nan), "nan"),
        (Volume(1.1), "1.1"),
    ],
)
def test_what_it_can_not_do_is_an_answer(awake: Driven, command: RobotCommand, words: str) -> None:
    assert words in data(awake, type(command).__name__, command)


def test_what_the_rods_do_not_reach_is_an_error(awake: Driven) -> None:
    far = {**dict.fromkeys(JOINTS, 0.0), "head_z": 0.02, "head_pitch": radians(30)}
    body = awake.robot.body
    postures = {**body.postures, "Far": far}
    object.__setattr__(body, "postures", postures)
    try:
        reason = data(awake, "far", Posture("Far"))
    finally:
        object.__setattr__(body, "postures", {n: p for n, p in postures.items() if n != "Far"})
    assert "the head does not reach the posture Far: its rods let `head_" in reason


def test_what_something_holds_is_an_error(awake: Driven, daemon: FakeDaemon, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(skills, "GRACE", 0.1)
    daemon.held = {"head_yaw": 0.0}
    assert "it is 11 degrees and 0 mm away" in data(awake, "l", Look(0.2))


def test_the_body_follows_the_head_and_no_joint_leaves_its_limits(awake: Driven, daemon: FakeDaemon) -> None:
    awake.answer("l", Look(2.5, 0.0))
    awake.robot.start("", Aim({"head_yaw": -9.0, "head_pitch": 9.0, "left_antenna": 50.0}, 5.0))
    awake.until(lambda: daemon.joints["head_yaw"] < -3.1, "the head has turned")
    body = awake.robot.body
    last = daemon.targets[0][1]
    for _, target in daemon.targets[1:]:
        assert abs(target["head_yaw"] - target[BODY]) <= radians(65) + 1e-9
        for name in JOINTS:
            joint = body.joints[name]
            assert joint.minimum - 1e-9 <= target[name] <= joint.maximum + 1e-9, name
            assert abs(target[name] - last[name]) <= joint.speed * 0.1 + 1e-6, name
        last = target


def test_it_looks_where_somebody_speaks(awake: Driven, daemon: FakeDaemon, project: Project) -> None:
    awake.robot.start("", Live(project.life["calm"]))
    daemon.doa = {"angle": 0.8, "speech_detected": True}
    awake.until(lambda: daemon.joints["head_yaw"] > 0.5, "it looks to its left")


def test_an_aim_leaves_alone_what_a_command_owns(awake: Driven, daemon: FakeDaemon) -> None:
    awake.robot.start("look", Look(0.3, 0.0))
    awake.tick()
    awake.robot.start("", Aim({"head_yaw": -0.5}, 0.5))
    assert awake.answer("look").name == "done.command.look"
    awake.until(lambda: abs(awake.joints()["head_yaw"] - 0.3) < 0.02, "it looks there")


def test_a_stop_ends_a_dance_where_it_is(awake: Driven, daemon: FakeDaemon, project: Project) -> None:
    awake.robot.start("d", Perform(project.motions["dance"]))
    awake.until(lambda: abs(daemon.joints["head_roll"]) > 0.1, "it dances")
    assert awake.answer("s", Stop("play")).name == "done.command.s"
    assert "cancelled.command.d" in awake.names()
    awake.tick()
    sent = len(awake.sent)
    end = time.monotonic() + 0.2
    awake.until(lambda: time.monotonic() > end, "some time")
    assert len(awake.sent) == sent


def test_speech_takes_its_time_and_the_volume_is_set_meanwhile(robot: Driven) -> None:
    began = time.monotonic()
    assert robot.answer("a", Say("x" * 20)).at - began > 1.0
    robot.robot.start("b", Say("x" * 600))
    robot.answer("v", Volume(0.4))
    assert not robot._answered("b")
    robot.answer("s", Stop("say"))
    assert "cancelled.command.b" in robot.names()


def test_a_sound_is_uploaded_once_and_played(project: Project, tmp_path: Path) -> None:
    import wave

    with wave.open(str(tmp_path / "ping.wav"), "wb") as file:
        file.setparams((1, 2, 8000, 0, "NONE", ""))
        file.writeframes(b"\x00\x40" * 800)
    daemon = FakeDaemon(media=True)
    robot = Driven(project, daemon.url, root=tmp_path)
    for i in range(2):
        assert robot.answer(f"s{i}", PlaySound("ping.wav", 0.1)).name == f"done.command.s{i}"
    robot.answer("v", Volume(0.5))
    robot.answer("quiet", PlaySound("ping.wav", 0.1))
    robot.answer("none", PlaySound("pong.wav", 0.1))
    assert "error.command.none" in robot.names()
    full, quiet = daemon.sounds.values()
    assert full == (tmp_path / "ping.wav").read_bytes()
    assert quiet[-2:] == b"\x00\x20"
    played = [body["file"] for path, body in daemon.asked if path == "/api/media/play_sound"]
    assert played == [list(daemon.sounds)[i] for i in (0, 0, 1)]
    robot.close()
    daemon.close()


def test_it_speaks_with_a_voice(project: Project) -> None:
    daemon = FakeDaemon(media=True)
    robot = Driven(project, daemon.url, voice="espeak")
    assert robot.answer("s", Say("Hello", "en")).name == "done.command.s"
    [sound] = daemon.sounds.values()
    assert sound[:4] == b"RIFF"
    assert len(sound) > 5_000
    robot.robot.start("long", Say("A long text.", "en"))
    robot.until(lambda: len(daemon.sounds) == 2, "it speaks")
    robot.tick()
    robot.robot.cancel("long")
    assert robot.answer("long").name == "cancelled.command.long"
    robot.until(lambda: "/api/media/stop_sound" in [path for path, _ in daemon.asked], "it is silent")
    robot.close()
    daemon.close()


def test_senses_are_those_of_its_body(awake: Driven, project: Project) -> None:
    assert set(awake.joints()) == set(project.body.joints)
    assert all(awake.robot.read(sense) is None for sense in Sense if sense is not Sense.JOINT)


def test_the_joints_are_stiff_until_it_sleeps(awake: Driven) -> None:
    def stiffness() -> set[float]:
        reading = awake.robot.read(Sense.JOINT)
        assert isinstance(reading, Joints)
        return set(reading.stiffness)

    assert stiffness() == {1.0}
    assert awake.answer("r", Rest()).name == "done.command.r"
    assert stiffness() == {0.0}


@for_each(
    ("url", "words"),
    [
        ("https://reachy-mini.local", "is no address of a daemon"),
        ("http://", "is no address"),
        ("tcp://nao.local:9559", "is no address"),
        ("reachy mini", "is no address"),
        ("http://a:b", "is no address"),
    ],
)
def test_what_is_no_address_is_said_so(url: str, words: str) -> None:
    with pytest.raises(UsageError, match=words):
        DaemonAddress(url)


def test_an_address_may_leave_out_scheme_and_port() -> None:
    assert str(DaemonAddress("reachy-mini.local")) == "http://reachy-mini.local:8000"
    assert str(DaemonAddress("http://10.0.0.7:9000/")) == "http://10.0.0.7:9000"


def test_without_a_daemon_there_is_an_error(project: Project) -> None:
    gone = FakeDaemon()
    gone.close()
    with pytest.raises(RobotError, match=f"the daemon at http://127.0.0.1:{gone.port} does not answer"):
        ReachyRobot(project.body, gone.url, time.monotonic)


def test_another_robot_is_refused_before_anything_moves(daemon: FakeDaemon) -> None:
    with pytest.raises(RobotModelError, match="NAO is no Reachy Mini: write `model: reachy_mini` under `robot`"):
        ReachyRobot(exhibits.BODY, daemon.url, time.monotonic)
    assert daemon.targets == []


def test_an_unknown_voice_is_said_so(project: Project, daemon: FakeDaemon) -> None:
    with pytest.raises(UsageError, match="there is no voice `espek`: did you mean `espeak`"):
        ReachyRobot(project.body, daemon.url, time.monotonic, voice="espek")
