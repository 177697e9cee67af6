"""The calls to NAOqi for each command, and the command's outcome."""

import logging
from dataclasses import replace
from itertools import pairwise
from math import hypot, nan

import pytest

from lumen.language.commands import Leds, Look, Move, PlaySound, Posture, Rest, Say, Stop, Volume, Wake, Walk
from lumen.language.motions import Cue, Interpolation, Keyframe, MotionDefinition
from lumen.language.projects import Project
from lumen.ports import Aim, Perform, Sense, Sonar
from tests.features.naoqi.conftest import Live
from tests.features.naoqi.lockstep import Lockstep


def reason(events: list) -> str:  # type: ignore[type-arg]
    """Return why the only answered command failed."""
    [answer] = [e for e in events if ".command." in e.name]
    assert answer.name.startswith("error."), answer
    return str(answer.data["reason"])


def answers(events: list) -> list[str]:  # type: ignore[type-arg]
    return [event.name for event in events]


@pytest.mark.slow
def test_it_is_taken_over_with_its_reflexes_on(robot: Lockstep) -> None:
    world = robot.nao.world
    assert world.called("setState") == [("disabled",)]
    assert world.called("setFallManagerEnabled") == [(True,)]
    assert world.called("setExternalCollisionProtectionEnabled") == [("All", True)]
    assert world.called("setSmartStiffnessEnabled") == [(True,)]


def test_a_motion_is_one_call(robot: Lockstep, live: Live, project: Project) -> None:
    motion = project.motions["goodbye"]
    robot.start("a", Perform(motion))
    assert answers(live(motion.duration + 1.0)) == ["done.command.a"]
    assert len(robot.nao.world.called("angleInterpolationBezier")) == 1
    angles = robot.nao.world.joints.angles()
    for joint, keys in motion.tracks.items():
        if joint not in project.body.shared:
            assert angles[joint] == pytest.approx(keys[-1].angle, abs=1e-3), joint


def test_a_first_key_that_is_too_soon_comes_later(robot: Lockstep, live: Live) -> None:
    motion = MotionDefinition("hasty", 0.1, {"HeadYaw": (Keyframe(0.1, 2.0, Interpolation.LINEAR),)})
    robot.start("a", Perform(motion))
    assert answers(live(1.0)) == ["done.command.a"]
    [(_, [times], _)] = robot.nao.world.called("angleInterpolationBezier")
    assert 2.0 / times[-1] <= robot.body.joints["HeadYaw"].speed


@pytest.mark.parametrize("keys", [(Keyframe(1.0, 3.0),), (Keyframe(1.0, 1.0), Keyframe(1.05, -1.0))])
def test_a_motion_is_sent_within_limits_and_speeds(robot: Lockstep, live: Live, keys: tuple[Keyframe, ...]) -> None:
    robot.start("a", Perform(MotionDefinition("wild", 2.0, {"HeadYaw": keys})))
    assert answers(live(5.0)) == ["done.command.a"]
    [(_, [times], [controls])] = robot.nao.world.called("angleInterpolationBezier")
    angles, limit = [0.0, *(control[0] for control in controls)], robot.body.joints["HeadYaw"]
    assert all(limit.minimum - 1e-9 <= angle <= limit.maximum + 1e-9 for angle in angles)
    ways = zip(pairwise(angles), pairwise([0.0, *times]), strict=True)
    assert all(abs(b - a) <= limit.speed * (end - begin) + 1e-9 for (a, b), (begin, end) in ways)


def test_what_is_no_angle_or_no_joint_is_never_sent(robot: Lockstep, live: Live) -> None:
    robot.start("a", Perform(MotionDefinition("wild", 2.0, {"HeadYaw": (Keyframe(1.0, nan),)})))
    assert "not a number" in reason(live(0.2))
    robot.start("b", Perform(MotionDefinition("wild", 2.0, {"HaedYaw": (Keyframe(1.0, 0.1),)})))
    assert "HeadYaw" in reason(live(0.2))
    assert robot.nao.world.called("angleInterpolationBezier") == []


@pytest.mark.slow
def test_cancelled_motions_end_and_go_back_to_where_they_began(robot: Lockstep, live: Live, project: Project) -> None:
    robot.start("a", Perform(project.motions["dance"]))
    live(5.0)
    robot.cancel("a")
    assert answers(live(1.0)) == ["cancelled.command.a"]
    stand, angles = project.body.postures["Stand"], robot.nao.world.joints.angles()
    assert angles["RShoulderPitch"] == pytest.approx(stand["RShoulderPitch"])
    assert angles["LKneePitch"] == pytest.approx(stand["LKneePitch"])


def test_lights_and_sounds_of_a_motion(robot: Lockstep, live: Live) -> None:
    cues = (Cue(0.0, "leds", {"eyes": "red", "left_ear": "#0000ff"}), Cue(0.1, "sound", "sounds/beat.wav"))
    robot.start("a", Perform(MotionDefinition("show", 0.5, {}, cues)))
    assert answers(live(1.0)) == ["cue", "done.command.a"]
    fades = [(group, colour) for group, colour, _ in robot.nao.world.called("fadeRGB")]
    assert sorted(fades) == [("FaceLeds", 0xFF0000), ("LeftEarLeds", 0x0000FF)]  # sent together


def test_lights_of_a_behaviour(robot: Lockstep, live: Live) -> None:
    robot.start("a", Leds({"eyes": "rebeccapurple", "left_ear": "off", "chest": "orange"}, 0.5))
    assert answers(live(1.0)) == ["done.command.a"]
    assert sorted(robot.nao.world.called("fadeRGB")) == [  # sent together
        ("ChestLeds", 0xFF6000, 0.5),
        ("FaceLeds", 0x663399, 0.5),
        ("LeftEarLeds", 0x000000, 0.5),
    ]


def test_a_sound_is_played_from_its_own_disk(robot: Lockstep, live: Live) -> None:
    robot.nao.world.sounds = {"/home/nao/lumen/sounds/bell.wav"}
    robot.start("a", PlaySound("sounds/bell.wav", 5.0))
    robot.start("b", PlaySound("sounds/none.wav", 1.0))
    assert answers(live(1.0)) == ["error.command.b"]
    assert answers(live(5.0)) == ["done.command.a"]
    robot.start("c", PlaySound("sounds/bell.wav", 5.0))
    assert answers(live(1.0)) == []
    robot.start("d", Stop("play"))
    assert sorted(answers(live(1.0))) == ["cancelled.command.c", "done.command.d"]
    assert robot.nao.world.called("ALAudioPlayer.stopAll")


def test_volume_is_that_of_its_speech(robot: Lockstep, live: Live) -> None:
    robot.start("a", Volume(0.4))
    robot.start("b", Volume(1.4))
    assert sorted(answers(live(0.5))) == ["done.command.a", "error.command.b"]
    assert robot.nao.world.called("setVolume") == [(0.4,)]


def test_cancelled_lights_have_their_colours_at_once(robot: Lockstep, live: Live) -> None:
    robot.start("a", Leds({"eyes": "red"}, 20.0))
    live(0.3)
    robot.cancel("a")
    assert answers(live(0.5)) == ["cancelled.command.a"]
    assert robot.nao.world.called("fadeRGB") == [("FaceLeds", 0xFF0000, 20.0), ("FaceLeds", 0xFF0000, 0.05)]


def test_each_sentence_in_its_language(robot: Lockstep, live: Live, caplog: pytest.LogCaptureFixture) -> None:
    with caplog.at_level(logging.WARNING):
        for i, (text, language) in enumerate(
            [("Hi", "en"), ("Salut", "fr"), ("Halo", "id"), ("Apa", "id"), ("Ok", "")]
        ):
            robot.start(str(i), Say(text, language))
        live(5.0)
    said = robot.nao.world.called("say")
    assert said == [("Hi", "English"), ("Salut", "French"), ("Halo", ""), ("Apa", ""), ("Ok", "")]
    assert ["no voice for `id`" in record.getMessage() for record in caplog.records] == [True]


def test_a_name_can_not_turn_up_the_volume(robot: Lockstep, live: Live) -> None:
    robot.start("a", Say("Hello \\vol=200\\ Budi\x07\n!", "en"))
    live(3.0)
    assert robot.nao.world.called("say") == [("Hello vol=200 Budi !", "English")]


def test_a_walk_takes_its_time_and_ends_where_it_should(robot: Lockstep, live: Live) -> None:
    robot.start("a", Walk(0.2, 0.1, 0.5))
    assert answers(live(5.0)) == ["done.command.a"]
    assert robot.nao.world.position == pytest.approx([0.2, 0.1, 0.5])


@pytest.mark.parametrize("version", ["2.8.6.23", "2.1.4.13"])
def test_a_walk_before_an_obstacle_has_failed(robot: Lockstep, live: Live, version: str) -> None:
    """`moveTo` returns False there, and nothing at all in NAOqi 2.1."""
    robot.nao.world.obstacle, robot.nao.world.version = True, version
    robot.start("a", Walk(0.25))
    assert "something is in its way" in reason(live(4.0))
    robot.nao.world.obstacle = False
    robot.start("b", Walk(-0.1))
    assert answers(live(4.0)) == ["done.command.b"]


def test_a_bumper_stops_a_walk(robot: Lockstep, live: Live) -> None:
    robot.start("a", Walk(0.3))
    live(1.0)
    robot.touch("LeftBumper", True)
    events = live(1.5)
    assert answers(events)[0] == "touched"
    assert "left bumper" in reason(events)
    assert 0.05 < robot.nao.world.position[0] < 0.2


def test_sonars_stop_a_walk(robot: Lockstep, live: Live) -> None:
    robot.start("a", Move(0.05))
    live(1.0)
    robot.nao.world.sonar = (0.3, 2.0)
    assert isinstance(echo := robot.read(Sense.SONAR), Sonar)
    assert echo.left == 0.3
    assert "0.30 m ahead" in reason(live(1.5))
    robot.start("b", Walk(0.1))
    assert "did not start walking" in reason(live(0.2))


def test_a_walk_ends_where_nobody_knows_where_it_is(robot: Lockstep, live: Live) -> None:
    robot.start("a", Walk(0.3))
    live(0.5)
    robot.nao.world.astray = True
    assert "the position of the robot is unknown (ALMotion::getRobotPosition no odometry)" in reason(live(1.5))
    robot.nao.world.astray = False
    assert robot.nao.world.position[0] < 0.15


def test_nobody_leaves_the_stage(robot: Lockstep, live: Live) -> None:
    robot.start("a", Walk(0.35))
    assert "leave the stage" in reason(live(0.5))
    assert robot.nao.world.called("moveTo") == []
    robot.start("b", Move(0.1))
    assert "leave the stage" in reason(live(9.0))
    assert robot.nao.world.position[0] < 0.4


def test_a_move_ends_when_it_is_told(robot: Lockstep, live: Live) -> None:
    robot.start("a", Move(0.05))
    live(0.5)
    robot.start("b", Move(-0.05))
    assert answers(live(0.5)) == ["done.command.a"]
    robot.cancel("b")
    assert answers(live(1.0)) == ["cancelled.command.b"]
    here = hypot(*robot.nao.world.position[:2])
    live(1.0)
    assert hypot(*robot.nao.world.position[:2]) == pytest.approx(here)


def test_rest_goes_out_while_a_call_hangs(robot: Lockstep, live: Live) -> None:
    """A walk that NAOqi does not end delays a rest no longer than the timeout of the call."""
    robot.start("a", Walk(0.3))
    live(0.5)
    robot.nao.world.deaf = True
    robot.start("rest", Rest())
    assert answers(live(4.5)) == ["error.command.a", "done.command.rest"]
    assert robot.nao.world.called("stopMove") != []
    assert not robot.nao.world.awake


def test_with_motors_off_nothing_moves(robot: Lockstep, live: Live, project: Project) -> None:
    robot.start("rest", Rest())
    live(3.0)
    for command in (Walk(0.1), Look(0.1, 0.1), Posture("Stand"), Perform(project.motions["photo"])):
        robot.start("a", command)
        assert "`wake` first" in reason(live(0.5))
    robot.start("wake", Wake())
    assert answers(live(4.0)) == ["done.command.wake"]


@pytest.mark.slow
def test_a_fall_ends_everything_until_it_is_up_again(robot: Lockstep, live: Live, project: Project) -> None:
    robot.start("a", Perform(project.motions["dance"]))
    live(1.0)
    robot.nao.tell("ALMotion/RobotIsFalling", 1)
    robot.nao.world.awake = False
    robot.settle()
    assert reason(live(0.1)) == "the robot fell"
    robot.nao.tell("robotHasFallen", 1)
    robot.settle()
    assert answers(live(0.1)) == ["fallen"]
    robot.start("b", Look(0.1, 0.1))
    assert "has fallen" in reason(live(0.1))
    robot.start("c", Posture("Stand"))
    assert answers(live(3.0)) == ["done.command.c"]


def test_aims_keep_to_limits_and_to_one_call_at_a_time(robot: Lockstep, live: Live) -> None:
    with robot.nao.times.lock:  # the robot is busy with the first
        for yaw in range(100):
            robot.start("", Aim({"HeadYaw": yaw / 10}, 5.0))
    robot.settle()
    live(0.1)
    widest = robot.body.joints["HeadYaw"].maximum
    assert robot.nao.world.called("setAngles") == [(["HeadYaw"], [0.0], 1.0), (["HeadYaw"], [widest], 1.0)]


def test_stop_names_what_it_stops(robot: Lockstep, live: Live, project: Project) -> None:
    robot.start("say", Say("x" * 100, "en"))
    robot.start("play", Perform(project.motions["photo"]))
    live(0.5)
    robot.start("stop", Stop("say"))
    assert set(answers(live(0.5))) == {"cancelled.command.say", "done.command.stop"}
    assert len(robot.nao.world.called("ALTextToSpeech.stopAll")) == 1


def test_a_sitting_robot_is_told_to_stand_first(robot: Lockstep, live: Live, project: Project) -> None:
    robot.start("sit", Posture("Sit"))
    live(3.0)
    robot.start("a", Walk(0.1))
    assert "send it to Stand first" in reason(live(0.5))
    robot.start("b", Perform(replace(project.motions["dance"], start="Stand")))
    assert "send it there first" in reason(live(0.5))
