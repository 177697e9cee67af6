"""Gestures beside speech: on the word, without repetition within three texts, and only if nothing else moves."""

from itertools import pairwise
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import lumen
from lumen.language.actions import SayText
from lumen.language.body_parts import ARMS, HEAD
from lumen.language.commands import Say, Start
from lumen.language.gestures import WordTime, merged
from lumen.lint.walk import action_sites
from lumen.motion.gestures import GESTURE_SHARE, gesture_offsets, peak_speeds, plan_gestures
from lumen.ports import Joints, Live, Sense
from lumen.robot.command_table import speech_duration
from lumen.robot.gesture_player import GesturePlayer
from lumen.robot.recording import RecordingRobot
from lumen.statechart import Machine, initial
from tests import ROOT

PROJECT = lumen.load(ROOT)
BODY, LIBRARY = PROJECT.body, merged(PROJECT.gestures)
TEXTS = [
    template.text
    for site in action_sites(PROJECT.machine)
    if isinstance(site.step.action, SayText)
    for template in site.step.action.texts.get("en", ())
]


def names(text: str, *, recent: tuple[str, ...] = (), seed: int = 0, language: str = "en") -> list[str]:
    planned = plan_gestures(text, language, LIBRARY, speech_duration(text), recent, seed)
    return [each.gesture.name for each in planned]


def tagged(tag: str) -> set[str]:
    return {gesture.name for gesture in LIBRARY.gestures if tag in gesture.tags}


def test_there_are_many_for_each_tag() -> None:
    assert len(LIBRARY.gestures) >= 24
    for tag in ("greeting", "you", "me", "number", "question", "yes", "no", "far", "big", "think", "beat"):
        assert len(tagged(tag)) >= 2, tag


@pytest.mark.parametrize(
    ("text", "language", "tag"),
    [
        ("Hello, my dear friends, who have come such a long way!", "en", "greeting"),
        ("Selamat datang, teman-teman yang datang dari jauh!", "id", "greeting"),
        ("In this hall stood 27 robots at the same time.", "en", "number"),
        ("Everybody came, and that was not so easy for them.", "en", "no"),
    ],
)
def test_what_is_said_chooses_the_gesture(text: str, language: str, tag: str) -> None:
    drawn = {name for seed in range(20) for name in names(text, seed=seed, language=language)}
    assert drawn & tagged(tag)
    assert not names("", language=language)


@settings(max_examples=150, deadline=None)
@given(st.sampled_from(TEXTS), st.floats(0.3, 30.0), st.integers(0, 50), st.sampled_from(["en", "id", ""]))
def test_gestures_follow_one_another_within_the_text(text: str, duration: float, seed: int, language: str) -> None:
    planned = plan_gestures(text, language, LIBRARY, duration, (), seed)
    assert planned == plan_gestures(text, language, LIBRARY, duration, (), seed)
    assert all(each.at >= 0 and each.at + each.gesture.duration <= duration + 0.5 for each in planned)
    assert all(one.at + one.gesture.duration <= other.at for one, other in pairwise(planned))


@given(st.lists(st.sampled_from(TEXTS), min_size=3, max_size=12))
@settings(max_examples=60, deadline=None)
def test_no_gesture_comes_twice_within_three_texts(texts: list[str]) -> None:
    player, said = GesturePlayer(BODY), []
    player.library = LIBRARY
    for i, text in enumerate(texts):
        said.append(player.say(Say(text, "en"), speech_duration(text), 100.0 * i))
    for i, drawn in enumerate(said):
        before = [name for earlier in said[max(0, i - 2) : i] for name in earlier]
        assert not set(drawn) & set(before)
        assert len(set(drawn)) == len(drawn)


def test_every_gesture_is_within_limits_on_both_sides_and_not_too_fast() -> None:
    stand = BODY.postures["Stand"]
    for gesture in LIBRARY.gestures:
        for joint, speed in peak_speeds(gesture).items():
            assert speed <= GESTURE_SHARE * BODY.joints[joint].speed, (gesture.name, joint)
        for tick in range(round(gesture.duration * 100)):
            for other in (False, gesture.mirrored):
                for joint, offset in gesture_offsets(gesture, tick / 100, other_side=other).items():
                    limits = BODY.joints[joint]
                    assert limits.minimum <= stand[joint] + offset <= limits.maximum, (gesture.name, joint)


def test_a_voice_that_tells_when_it_says_each_word_has_the_stroke_there() -> None:
    text = "We have 27 of them standing in the other building."
    (guessed,) = plan_gestures(text, "en", LIBRARY, 8.0, (), 0)
    words = [WordTime(text.index("have"), 0.4), WordTime(text.index("27"), 3.0), WordTime(text.index("of"), 3.4)]
    (told,) = plan_gestures(text, "en", LIBRARY, 8.0, (), 0, words)
    assert told.at + told.gesture.stroke == pytest.approx(3.0)
    assert guessed.at + guessed.gesture.stroke == pytest.approx(8.0 * text.index("27") / len(text), abs=0.01)


def test_a_motion_that_has_the_arms_keeps_them() -> None:
    player = GesturePlayer(BODY)
    player.library = LIBRARY
    player.say(Say("Hello, I have two big friends over there, do you know them?", "en"), 6.0, 0.0)
    moved = {joint for tick in range(600) for joint in player.wanted(tick / 100, {ARMS, HEAD})}
    assert moved & set(BODY.parts[ARMS])
    assert not {joint for tick in range(600) for joint in player.wanted(tick / 100, {HEAD})} & set(BODY.parts[ARMS])
    assert not any(player.wanted(tick / 100, ()) for tick in range(600))


@pytest.mark.parametrize("gestures", [True, False])
def test_the_arms_rise_while_the_robot_speaks_unless_a_state_says_none(gestures: bool) -> None:
    robot = RecordingRobot(BODY)
    robot.start("", Live(PROJECT.life["calm"], LIBRARY) if gestures else Live(PROJECT.life["calm"]))
    robot.start("c1", Say("Welcome, my friends, to all of our 27 big robots over there!", "en"))
    farthest = 0.0
    for _ in range(50):
        robot.advance(0.1)
        reading = robot.read(Sense.JOINT)
        assert isinstance(reading, Joints)
        angles = dict(zip(reading.names, reading.angles, strict=True))
        farthest = max(farthest, *(BODY.postures["Stand"][j] - angles[j] for j in ("LShoulderPitch", "RShoulderPitch")))
    assert (farthest > 0.3) == gestures


def test_a_text_may_do_without(tmp_path: Path) -> None:
    player = GesturePlayer(BODY)
    player.library = LIBRARY
    text = "Welcome, my friends, to all of our 27 big robots over there!"
    assert player.say(Say(text, "en"), 6.0, 0.0)
    assert not player.say(Say(text, "en", "none"), 6.0, 9.0)
    file = tmp_path / "quiet.yaml"
    file.write_text("id: quiet\nentry: {say: {en: Hello!, id: Halo!, gestures: none}}\nstates: {a: {}}\n")
    said = [c.command for c in initial(Machine.load(file), language="id").commands if isinstance(c, Start)]
    assert said == [Say("Halo!", "id", "none")]
