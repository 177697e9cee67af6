"""A simulated robot that lives stands as firmly as without life, and performs commands as before."""

import numpy as np
import pytest

import lumen
from lumen.features.simulation.offers import SimulatedRobot
from lumen.features.simulation.subject import subject
from lumen.language.commands import Leds, Rest, Say
from lumen.language.stories import Visitor
from lumen.ports import Live, Perform
from tests import ROOT

PROJECT = lumen.load(ROOT)
MODELS = ROOT / "models"


def robot(style: str = "lively") -> SimulatedRobot:
    made = SimulatedRobot(PROJECT.body, MODELS, "hall.xml")
    made.start("", Live(PROJECT.life[style]))
    return made


def test_it_moves_and_does_not_lean() -> None:
    nao = robot()
    nao.advance(1.0)
    last, seen = nao.world.angles.copy(), []
    for _ in range(8):
        nao.advance(0.5)
        seen.append(float(np.abs(nao.world.angles - last).max()))
        last = nao.world.angles.copy()
    assert min(seen) > 0.0017
    assert nao.greatest_tilt < 3.0


@pytest.mark.soak
@pytest.mark.parametrize("style", sorted(PROJECT.life))
@pytest.mark.parametrize("brother", range(1, 6))
def test_no_style_tips_any_robot(style: str, brother: int) -> None:
    nao = subject(PROJECT.body, MODELS, "hall.xml", brother)
    nao.start("", Live(PROJECT.life[style]))
    nao.advance(40.0)
    assert nao.greatest_tilt < 4.0
    assert not nao.fallen


def test_a_motion_has_its_joints_to_itself_and_ends_as_without_life() -> None:
    nao, motion = robot(), PROJECT.motions["goodbye"]
    nao.advance(2.0)
    nao.start("wave", Perform(motion))
    nao.advance(2.0)  # past the moment in which life lets go
    for _ in range(20):
        nao.advance(0.05)
        inside = np.clip(nao.motors.goal, nao.motors.envelope.low, nao.motors.envelope.high)
        arms = [nao.motors.index[joint] for joint in PROJECT.body.parts["arms"]]
        assert np.abs(nao.motors.command - inside)[arms].max() < 1e-3
    nao.advance(motion.duration)
    assert any(event.name == "done.command.wave" for event in nao.poll())


def test_its_eyes_say_what_it_does_unless_they_are_lit() -> None:
    nao = robot("listening")

    def eyes() -> list[tuple[float, ...]]:
        return [tuple(nao.lights.shown("left_eye").round(2).tolist()), *seen(nao, "left_eye")]

    def seen(nao: SimulatedRobot, light: str) -> list[tuple[float, ...]]:
        material = nao.world.model.mat_rgba[nao.world.model.material(f"nao/{light}").id, :3]
        return [tuple(material.round(2).tolist())]

    nao.advance(0.5)
    listens = eyes()[1]
    nao.start("say", Say("Let me think about that for a while, my friend.", "en"))
    nao.advance(0.6)
    thinks = eyes()[1]
    nao.advance(1.5)
    speaks = eyes()[1]
    assert len({listens, thinks, speaks}) == 3
    nao.start("red", Leds({"eyes": "red"}))
    nao.advance(0.3)
    assert eyes()[0] == eyes()[1] not in (listens, thinks, speaks)
    nao.advance(3.0)
    nao.start("white", Leds({"eyes": "white"}))
    nao.advance(0.3)
    assert eyes()[1] == listens


def test_it_looks_towards_somebody_who_speaks_beside_it() -> None:
    nao = robot("listening")
    nao.place(Visitor(1.0, 1.2, 1.6))
    nao.advance(1.0)
    nao.sound()
    nao.advance(1.5)
    assert nao.world.angles[nao.motors.index["HeadYaw"]] > 0.6
    nao.advance(4.0)
    assert abs(nao.world.angles[nao.motors.index["HeadYaw"]]) < 0.3


def test_a_robot_that_rests_is_still() -> None:
    nao = robot()
    nao.start("rest", Rest())
    nao.advance(8.0)
    assert not nao.awake
    told = nao.motors.command.copy()
    nao.advance(1.0)
    assert np.array_equal(nao.motors.command, told)


def test_the_same_seed_is_the_same_run() -> None:
    def run() -> list[float]:
        nao = robot("calm")
        nao.advance(2.0)
        return list(nao.world.angles)

    assert run() == run()
