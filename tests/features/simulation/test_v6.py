"""models/v6.yaml: NAO's body with the head of V6, as published (Aldebaran's NAOH25V60.urdf)."""

from dataclasses import replace
from math import degrees

import mujoco
import numpy as np
import pytest

import lumen
from lumen.features.simulation.falling_sense import MassModel
from lumen.features.simulation.offers import SimulatedRobot
from lumen.language.commands import Walk
from lumen.language.robots import Body
from lumen.project.building import draft
from lumen.project.files import read_files
from tests.features.simulation.conftest import MODELS, answer, until_answered

TOTAL = 5.35975
MASS, CENTRE = 0.65973, (0.00108886, 0.00146278, 0.0571855)
INERTIA = (0.00077097, 0.000680374, 0.000714702, 4.76784e-06, 9.62477e-06, -1.85791e-05)


@pytest.fixture(scope="module")
def v6() -> Body:
    return draft(read_files(MODELS.parent)).bodies["v6"]


def test_only_head_camera_and_sonar_differ(body: Body, v6: Body) -> None:
    assert replace(v6, name=body.name, camera=body.camera, sonar=body.sonar, links={}) == body
    assert degrees(v6.camera.horizontal_fov) == pytest.approx(56.3, abs=0.01)
    assert degrees(v6.camera.vertical_fov) == pytest.approx(43.7, abs=0.01)
    assert v6.sonar
    assert (v6.sonar.minimum, v6.sonar.maximum) == (0.2, 0.8)


def test_its_masses_are_the_published_ones(v6: Body) -> None:
    model = SimulatedRobot(v6, MODELS).world.model
    head = model.body("nao/HeadPitch")
    assert model.body_subtreemass[model.body("nao/Torso").id] == pytest.approx(TOTAL, rel=1e-6)
    assert head.mass[0] == pytest.approx(MASS)
    assert head.ipos == pytest.approx(CENTRE)
    turned = np.zeros(9)
    mujoco.mju_quat2Mat(turned, head.iquat)
    axes = turned.reshape(3, 3)
    inertia = axes @ np.diag(head.inertia) @ axes.T
    assert inertia[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]] == pytest.approx(INERTIA, abs=1e-9)
    assert model.camera("nao/CameraTop").fovy[0] == pytest.approx(43.7, abs=0.01)


def test_it_knows_its_own_weight(body: Body, v6: Body) -> None:
    stand = body.postures["Stand"]
    higher = MassModel(v6, MODELS).centre_of_mass(stand) - MassModel(body, MODELS).centre_of_mass(stand)
    assert 0.001 < higher[2] < 0.003


def test_it_stands_and_walks(v6: Body) -> None:
    robot = SimulatedRobot(v6, MODELS)
    robot.start("w", Walk(0.2))
    assert answer(until_answered(robot, "w"), "w") == "done"
    assert robot.greatest_tilt < 10


@pytest.mark.slow
def test_a_project_names_it() -> None:
    files = read_files(MODELS.parent)
    main = files["lumen.yaml"].replace(b"model: nao", b"model: v6")
    assert main != files["lumen.yaml"]
    found = draft({**files, "lumen.yaml": main})
    assert found.body is not None
    assert found.body.name == "NAO V6"
    assert found.motions.keys() == lumen.load(MODELS.parent).motions.keys()
