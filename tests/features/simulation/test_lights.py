"""The lights of the simulated robot: which command sets them, when, and how they are drawn."""

import numpy as np
import pytest
from numpy.typing import NDArray

from lumen.features.simulation.offers import SimulatedRobot
from lumen.features.simulation.rendering import FILM_QUALITY, RenderState, SceneRenderer
from lumen.language.commands import Leds, Rest, Say
from lumen.language.motions import Cue, Keyframe, MotionDefinition
from lumen.ports import Perform
from tests.features.simulation.conftest import Do, answer, until_answered

NOD = MotionDefinition(
    "nod", 2.0, {"HeadPitch": (Keyframe(1.0, 0.2), Keyframe(2.0, 0.0))}, (Cue(0.1, "leds", {"eyes": "red"}),)
)


def colour(robot: SimulatedRobot, light: str) -> tuple[float, ...]:
    return tuple(robot.world.model.mat_rgba[robot.world.model.material(f"nao/{light}").id, :3].round(3).tolist())


def test_lights_go_an_even_way_to_their_colours(robot: SimulatedRobot) -> None:
    before = colour(robot, "chest")
    robot.start("a", Leds({"chest": "#ff8000", "left_eye": "blue"}, 1.0))
    robot.advance(0.5)
    assert colour(robot, "chest") == pytest.approx(
        [(a + b) / 2 for a, b in zip(before, (1, 0.5, 0), strict=True)], abs=0.02
    )
    assert answer(until_answered(robot, "a"), "a") == "done"
    assert robot.time == pytest.approx(1.0, abs=0.05)
    assert colour(robot, "chest") == pytest.approx((1.0, 0.502, 0.0), abs=0.001)
    assert colour(robot, "left_eye") != colour(robot, "right_eye")


def test_a_motion_keeps_the_lights_that_it_sets_and_no_others(robot: SimulatedRobot) -> None:
    robot.start("nod", Perform(NOD))
    robot.advance(0.5)
    robot.start("eyes", Leds({"left_eye": "green"}))
    robot.start("chest", Leds({"chest": "green"}))
    events = until_answered(robot, "eyes")
    assert [event.name for event in events] == ["done.command.chest", "done.command.nod", "done.command.eyes"]
    assert robot.time == pytest.approx(2.0, abs=0.1)


def test_a_motion_waits_for_the_lights_that_it_sets(robot: SimulatedRobot) -> None:
    robot.start("eyes", Leds({"left_eye": "green"}, 1.0))
    robot.advance(0.1)
    robot.start("nod", Perform(NOD))
    until_answered(robot, "nod")
    assert robot.time == pytest.approx(3.0, abs=0.1)


def test_a_cancelled_motion_takes_back_its_own_lights(robot: SimulatedRobot, do: Do) -> None:
    eye = colour(robot, "left_eye")
    assert do(Leds({"chest": "green"})) == "done"
    chest = colour(robot, "chest")
    robot.start("nod", Perform(NOD))
    robot.advance(0.5)
    assert colour(robot, "left_eye") != eye
    robot.cancel("nod")
    robot.advance(0.1)
    assert (colour(robot, "left_eye"), colour(robot, "chest")) == (eye, chest)


def test_ears_glow_with_speech_and_show_then_what_was_set(robot: SimulatedRobot, do: Do) -> None:
    assert do(Leds({"left_ear": "red"})) == "done"
    red = colour(robot, "left_ear")
    robot.start("say", Say("x" * 20))
    robot.advance(0.2)
    glowing = colour(robot, "left_ear")
    assert glowing != red
    robot.start("right", Leds({"right_ear": "red"}))
    robot.advance(0.2)
    assert colour(robot, "right_ear") == glowing
    until_answered(robot, "say")
    assert (colour(robot, "left_ear"), colour(robot, "right_ear")) == (red, red)


def test_a_resting_robot_looks_as_it_was_switched_on(robot: SimulatedRobot, do: Do) -> None:
    before = colour(robot, "head")
    assert do(Leds({"head": "gold"})) == "done"
    assert do(Rest()) == "done"
    assert colour(robot, "head") == before
    assert do(Leds({"head": "gold"})) == "done"
    assert colour(robot, "head") != before


@pytest.mark.pictures
def test_what_is_set_is_drawn_and_nothing_else(robot: SimulatedRobot, do: Do) -> None:
    def portrait() -> NDArray[np.int64]:
        state = RenderState.of(robot.world.model, robot.world.data)
        return renderer.draw(state, "close", 320, 240).astype(int)

    renderer = SceneRenderer(robot.world.model, FILM_QUALITY)
    before = portrait()
    again = portrait()
    assert do(Leds({"eyes": "red"})) == "done"
    changed = np.abs(portrait() - before).sum(axis=2) > 60
    renderer.close()
    assert np.abs(again - before).max() < 4
    assert 0 < changed.mean() < 0.05
