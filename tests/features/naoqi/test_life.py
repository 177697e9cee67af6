"""Life on a real NAO: head and arms move slightly while nothing else moves the robot."""

from dataclasses import replace
from itertools import chain

import pytest

from lumen.language.commands import Leds, Look, Posture, Rest, Say
from lumen.language.gestures import merged
from lumen.language.life import STILL_STYLE
from lumen.language.projects import Project
from lumen.motion.bounds import nearest_angles
from lumen.ports import Live, Perform
from tests.features.naoqi.conftest import Live as LiveFor
from tests.features.naoqi.lockstep import Lockstep


def sent(robot: Lockstep) -> list[tuple[str, ...]]:
    """Return the joints of each call of `setAngles`."""
    return [tuple(names) for names, _, _ in robot.nao.world.called("setAngles")]


@pytest.fixture
def standing(robot: Lockstep, live: LiveFor, project: Project) -> Lockstep:
    robot.start("", Live(project.life["lively"], merged(project.gestures)))
    robot.start("a", Posture("Stand"))
    live(5.0)
    return robot


def test_head_and_arms_move_and_legs_do_not(standing: Lockstep, live: LiveFor, project: Project) -> None:
    before = standing.nao.world.joints.angles()
    live(2.0)
    after = standing.nao.world.joints.angles()
    moved = {joint for joint in before if abs(before[joint] - after[joint]) > 0.002}
    assert moved & set(project.body.parts["arms"])
    assert not set(chain.from_iterable(sent(standing))) & set(project.body.parts["legs"])


def test_it_keeps_limits_that_depend_on_another_joint(standing: Lockstep, live: LiveFor, project: Project) -> None:
    """A head that is turned and lowered as far as it can be is moved no farther by its glances."""
    standing.start("b", Look(1.5, 0.3))
    live(3.0)
    calls = len(standing.nao.world.called("setAngles"))
    live(20.0)
    goals = [
        dict(zip(names, angles, strict=True)) for names, angles, _ in standing.nao.world.called("setAngles")[calls:]
    ]
    heads = [{name: goal[name] for name in ("HeadYaw", "HeadPitch")} for goal in goals if "HeadYaw" in goal]
    assert len({head["HeadPitch"] for head in heads}) > 10, "it is alive"
    assert [head for head in heads if nearest_angles(head, project.body) != head] == []


def test_arms_accompany_what_it_says(standing: Lockstep, live: LiveFor) -> None:
    stands, highest = standing.nao.world.joints.angles(), 0.0
    standing.start("b", Say("Welcome, my friends, to all of our 27 big robots over there!", "en"))
    for _ in range(40):
        live(0.1)
        angles = standing.nao.world.joints.angles()
        highest = max(highest, *(stands[joint] - angles[joint] for joint in ("LShoulderPitch", "RShoulderPitch")))
    assert highest > 0.2


def test_a_motion_is_left_alone(standing: Lockstep, live: LiveFor, project: Project) -> None:
    standing.start("b", Perform(project.motions["goodbye"]))
    live(0.1)
    before = len(sent(standing))
    live(2.0)
    assert len(sent(standing)) == before


@pytest.mark.parametrize("how", ["rests", "still", "never stood"])
def test_it_is_still(robot: Lockstep, live: LiveFor, project: Project, how: str) -> None:
    robot.start("", Live(project.life["lively"]))
    if how != "never stood":
        robot.start("a", Posture("Stand"))
        live(3.0)
    if how == "rests":
        robot.start("b", Rest())
    elif how == "still":
        robot.start("", Live(STILL_STYLE))
    live(4.0)
    before = len(sent(robot))
    live(2.0)
    assert len(sent(robot)) == before


def eyes(robot: Lockstep) -> list[int]:
    """Return the colours in which the eyes were lit, in order."""
    return [colour for group, colour, _ in robot.nao.world.called("fadeRGB") if group == "FaceLeds"]


def alive(robot: Lockstep, project: Project, *naoqi: str, style: str = "lively") -> None:
    own = replace(project.life[style], naoqi=naoqi)
    robot.start("", Live(own, merged(project.gestures)))


def test_its_eyes_blink_and_say_what_it_does_unless_they_are_lit(
    standing: Lockstep, live: LiveFor, project: Project
) -> None:
    alive(standing, project, style="listening")
    live(8.0)
    assert set(eyes(standing)) >= {0x000000, 0x00BFFF}
    standing.start("c", Leds({"eyes": "red"}))
    live(1.0)
    before = len(eyes(standing))
    live(8.0)
    assert len(eyes(standing)) == before
    standing.start("d", Leds({"eyes": "white"}))
    live(2.0)
    assert eyes(standing)[-1] in (0x000000, 0x00BFFF)


def test_its_legs_sway_where_the_style_says_so(standing: Lockstep, live: LiveFor, project: Project) -> None:
    alive(standing, project, "legs")
    standing.start("b", Posture("Stand"))
    live(8.0)
    legs = set(project.body.parts["legs"])
    before = {joint: angle for joint, angle in standing.nao.world.joints.angles().items() if joint in legs}
    assert set(chain.from_iterable(sent(standing))) & legs
    live(2.0)
    far = {joint: abs(standing.nao.world.joints.angles()[joint] - angle) for joint, angle in before.items()}
    assert 0.002 < max(far.values()) < 0.1


def test_naoqi_breathes_in_place_of_our_sways_and_not_while_a_motion_plays(
    standing: Lockstep, live: LiveFor, project: Project
) -> None:
    alive(standing, project, "breathing")
    live(1.0)
    breathing = standing.nao.world.called("setBreathEnabled")
    assert sorted(breathing) == [("Arms", True), ("Legs", True)]
    live(1.0)
    before = len(sent(standing))
    live(3.0)
    assert set(chain.from_iterable(sent(standing)[before:])) == set(project.body.parts["head"])
    standing.start("b", Perform(project.motions["goodbye"]))
    live(0.1)
    assert sorted(standing.nao.world.called("setBreathEnabled")[2:]) == [("Arms", False), ("Legs", False)]


def test_naoqi_gestures_as_it_speaks_in_place_of_ours(standing: Lockstep, live: LiveFor, project: Project) -> None:
    alive(standing, project, "speech", "blinking")
    live(0.1)
    before = len(eyes(standing))
    text = "Welcome ^run(evil), my friends, to all of our 27 big robots over there!"
    standing.start("b", Say(text, "en"))
    standing.start("c", Say("Hush.", "en", "none"))
    live(10.0)
    world = standing.nao.world
    said = "Welcome run(evil), my friends, to all of our 27 big robots over there!"
    assert world.called("ALAnimatedSpeech.say") == [(said, {"bodyLanguageMode": "contextual"})]
    assert world.called("setLanguage") == [("English",)]
    assert world.called("say") == [("Hush.", "English")]
    assert world.called("ALAutonomousBlinking.setEnabled") == [(True,)]
    assert len(eyes(standing)) > before
    assert 0x000000 not in eyes(standing)[before:]
    alive(standing, project)
    live(0.1)
    assert world.called("ALAutonomousBlinking.setEnabled")[-1] == (False,)


def test_it_looks_towards_a_sound_that_naoqi_is_sure_of(standing: Lockstep, live: LiveFor, project: Project) -> None:
    alive(standing, project, style="listening")
    live(1.0)
    heard = [[7, 0], [0.6, 0.1, 0.2, 0.5], [0.0] * 6, [0.0] * 6]
    standing.nao.tell("ALSoundLocalization/SoundLocated", heard)
    standing.nao.tell("ALSoundLocalization/SoundLocated", "noise")
    live(1.5)
    assert standing.nao.world.joints.angles()["HeadYaw"] < 0.3
    heard[1][2] = 0.9
    standing.nao.tell("ALSoundLocalization/SoundLocated", heard)
    live(1.5)
    assert standing.nao.world.joints.angles()["HeadYaw"] > 0.4
