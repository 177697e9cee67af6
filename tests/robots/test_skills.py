"""Commands beyond a body's skills: robots refuse them, behaviours leave them out, both with the same words."""

from dataclasses import replace
from math import inf, nan
from pathlib import Path

import pytest

import lumen
from lumen.errors import BadCommandError
from lumen.language.commands import GoTo, Leds, Look, Move, Posture, Rest, Say, Walk
from lumen.language.motions import Keyframe, MotionDefinition
from lumen.language.roles import Base, Roles
from lumen.language.skills import lack_of, tracking_lack
from lumen.ports import Aim, Perform, RobotCommand, Sense
from lumen.robot.command_table import check_command
from lumen.robot.recording import RecordingRobot
from tests import ROOT
from tests.exhibits import BODY
from tests.tables import for_each

STUMP = replace(BODY, name="Stump", roles=Roles())
SHIPPED = ROOT
TABLE = """\
joints: {Spin: {range: [-1, 1]}}
parts: {head: [Spin]}
postures: {Stand: {Spin: 0}}
"""
BEHAVIOUR = """\
id: hello
initial: here
states:
  here:
    do:
      - {walk: {x: 0.1}}
      - {look: {yaw: 0.1}}
      - {leds: {eyes: blue}}
      - {say: Hello}
    onDone: there
  there: {}
"""


@pytest.mark.parametrize(
    ("command", "lacks"),
    [
        (Walk(0.1), "Stump has neither legs nor wheels"),
        (Move(0.1), "Stump has neither legs nor wheels"),
        (Look(0.1), "Stump has no head that turns"),
        (Leds({"eyes": "blue", "chest": "red"}), "Stump has no lights `eyes`, `chest`"),
    ],
)
def test_robots_refuse_what_the_body_lacks_in_lint_s_words(command: object, lacks: str) -> None:
    lack = lack_of(command, STUMP)
    assert lack is not None
    assert lack.message == lacks
    with pytest.raises(BadCommandError, match=lacks):
        check_command(command, STUMP)  # type: ignore[arg-type]
    assert lack_of(command, BODY) is None


def motion(**tracks: tuple[Keyframe, ...]) -> Perform:
    return Perform(MotionDefinition("nod", 1.0, tracks))


@for_each(
    ("command", "reason"),
    [
        (Look(nan, 0.0), "`HeadYaw` cannot move to nan"),
        (Look(0.0, inf), "`HeadPitch` cannot move to inf"),
        (Aim({"HaedYaw": 0.1}), "`HaedYaw` is not a joint of this robot: did you mean `HeadYaw`"),
        (Aim({"HeadYaw": nan}), "`HeadYaw` cannot move to nan"),
        (Aim({"HeadYaw": 0.1}, 0.0), "a speed must be above 0 and at most 1, not 0"),
        (Aim({"HeadYaw": 0.1}, nan), "a speed must be above 0 and at most 1, not nan"),
        (motion(HaedYaw=(Keyframe(1.0, 0.1),)), "`HaedYaw` is not a joint of this robot: did you mean `HeadYaw`"),
        (motion(HeadYaw=(Keyframe(1.0, nan),)), "`nod` has an angle or a time that is not a number"),
        (motion(HeadYaw=(Keyframe(1.0, 0.1, handle_in=(0.1, inf)),)), "`nod` has an angle or a time"),
        (Perform(MotionDefinition("nod", inf, {})), "`nod` has an angle or a time that is not a number"),
        (motion(HeadYaw=(Keyframe(0.0, 0.1),)), "the times of the keys of `HeadYaw` must be above 0 and increase"),
        (motion(HeadYaw=(Keyframe(1.0, 0.1), Keyframe(1.0, 0.2))), "the times of the keys of `HeadYaw` must"),
    ],
)
def test_every_robot_refuses_what_is_no_goal_for_its_joints(command: RobotCommand, reason: str) -> None:
    with pytest.raises(BadCommandError) as refused:
        check_command(command, BODY)
    assert reason in str(refused.value)
    robot = RecordingRobot(BODY)
    robot.start("a", command)
    robot.advance(1.0)
    assert [event.name for event in robot.poll()] == ([] if isinstance(command, Aim) else ["error.command.a"])
    assert robot.read(Sense.JOINT) == replace(RecordingRobot(BODY).read(Sense.JOINT), time=1.0)


def test_what_every_body_can_do_lacks_nothing() -> None:
    for command in (Say("Hello"), Rest(), Posture("Stand")):
        assert lack_of(command, STUMP) is None
    assert lack_of(GoTo("organ"), STUMP) is not None


def test_wheels_walk_and_one_light_of_two_is_enough() -> None:
    body = replace(STUMP, roles=Roles(base=Base("wheels"), lights={"eyes": ("eyes",)}))
    assert lack_of(Walk(0.1), body) is None
    assert lack_of(Leds({"eyes": "blue", "feet": "red"}), body) is None


def test_a_controller_that_finds_one_of_its_joints_tracks() -> None:
    controller = lumen.load(SHIPPED).controllers["head"]
    bindings = tuple(
        replace(b, joint=f"head.{way}") for b, way in zip(controller.output_bindings, ("yaw", "pitch"), strict=True)
    )
    by_role = replace(controller, output_bindings=bindings)
    lack = tracking_lack(by_role, STUMP)
    assert lack is not None
    assert lack.message == "Stump has no `head.yaw`, `head.pitch`"
    turning = replace(bindings[0], joint="HeadYaw")
    assert tracking_lack(replace(controller, output_bindings=(turning, bindings[1])), STUMP) is None


@pytest.fixture
def table(tmp_path: Path) -> Path:
    for name, text in {
        "lumen.yaml": "behavior: hello\nlanguages: [en]\nrobot: {name: Lamp, model: lamp}\nhall: hall.xml\n",
        "behaviors/hello.yaml": BEHAVIOUR,
        "models/lamp.yaml": TABLE,
        "models/lamp.xml": '<mujoco><worldbody><body><joint name="Spin"/></body></worldbody></mujoco>\n',
    }.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text, "utf-8")
    return tmp_path


def test_lint_says_at_the_verb_what_is_left_out_and_nothing_is_wrong(table: Path) -> None:
    found = [d for d in lumen.check(table) if d.code == "left-out"]
    assert [(d.place.line, d.place.column, d.severity) for d in found] == [
        (6, 10, "info"),
        (7, 10, "info"),
        (8, 10, "info"),
    ]
    assert found[0].message == "lamp has neither legs nor wheels, so it leaves out `walk`"
    assert "base: {kind: biped}" in found[0].hint


def test_a_behaviour_goes_on_without_it(table: Path) -> None:
    with lumen.open(table, robot="recording", speed="max") as exhibition:
        exhibition.run(seconds=3)
        assert exhibition.configuration == frozenset({"there"}) or "there" in exhibition.configuration
