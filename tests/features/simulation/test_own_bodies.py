"""The three bodies that are Lumen's own beside NAO, in MuJoCo alone: their weights, and whether they stand."""

import json

import jsonschema
import mujoco
import numpy as np
import pytest
import yaml

from lumen.features.simulation.model_terms import Variation
from lumen.features.simulation.world_model import physics
from lumen.project.bodies import build_body
from lumen.project.document_report import DocumentReport
from lumen.project.yaml_reader import parse
from tests import ROOT

MODELS = ROOT / "models"
WEIGHTS = {"greeter": (30.0, 40.0), "lantern": (1.0, 2.0), "sprout": (2.0, 3.0)}
"""Least and greatest mass [kg]."""
HEIGHTS = {"greeter": (1.2, 1.5), "lantern": (0.3, 0.4), "sprout": (0.3, 0.42)}
"""Least and greatest height of the highest point in Stand above the floor [m]."""
KINDS = {"greeter": "wheels", "lantern": "fixed", "sprout": "biped"}
SETTLED, LONGER = 3.0, 10.0
"""Simulated times [s]: until everything has come to rest, and then of observation."""

SAMPLES = [
    (name, posture) for name in KINDS for posture in yaml.safe_load((MODELS / f"{name}.yaml").read_text())["postures"]
]

own = pytest.mark.parametrize("name", KINDS)


def described(name: str) -> dict:
    return yaml.safe_load((MODELS / f"{name}.yaml").read_text())


def posed(name: str, posture: str) -> tuple[mujoco.MjModel, mujoco.MjData]:
    """Return the body on a floor in that posture, held by its motors; a body that is not fixed can fall."""
    spec = mujoco.MjSpec.from_file(str(MODELS / f"{name}.xml"))
    if KINDS[name] != "fixed":
        spec.worldbody.first_body().add_freejoint()
    spec.worldbody.add_geom(
        name="floor",
        type=mujoco.mjtGeom.mjGEOM_PLANE,
        size=[0, 0, 0.05],
        friction=[0.8, 0.005, 0.0001],
        solref=[0.015, 1],
    )
    spec.option.timestep = 0.002
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    model = spec.compile()
    data = mujoco.MjData(model)
    for joint, angle in described(name)["postures"][posture].items():
        data.qpos[model.joint(joint).qposadr[0]] = angle
        data.ctrl[model.actuator(joint).id] = angle
    mujoco.mj_forward(model, data)
    if KINDS[name] != "fixed":
        data.qpos[2] = -_lowest(model, data)
        mujoco.mj_forward(model, data)
    return model, data


def _lowest(model: mujoco.MjModel, data: mujoco.MjData) -> float:
    """Return the height of the lowest point that can touch the floor, relative to the root's frame [m]."""
    lowest = 0.0
    for i in np.flatnonzero(model.geom_contype):
        size, up = model.geom_size[i], np.abs(data.geom_xmat[i].reshape(3, 3)[2])
        match model.geom_type[i]:
            case mujoco.mjtGeom.mjGEOM_BOX:
                reach = float(up @ size)
            case mujoco.mjtGeom.mjGEOM_SPHERE:
                reach = size[0]
            case mujoco.mjtGeom.mjGEOM_CYLINDER:
                reach = size[0] * np.sqrt(max(0.0, 1 - up[2] ** 2)) + size[1] * up[2]
            case _:
                continue
        lowest = min(lowest, data.geom_xpos[i][2] - reach)
    return lowest


@own
def test_it_is_described_as_the_schema_says_and_loads_without_a_word(name: str) -> None:
    schema = json.loads((MODELS.parent / "schemas" / "body.schema.json").read_text())
    document, complaints = parse(f"models/{name}.yaml", (MODELS / f"{name}.yaml").read_bytes())
    assert document is not None
    assert not complaints
    assert not list(jsonschema.Draft202012Validator(schema).iter_errors(document.data))
    report = DocumentReport(document)
    body = build_body(document.data, report, name=name)
    assert not report.diagnostics
    assert body is not None
    assert body.roles.base.kind == KINDS[name]
    assert len(body.postures) >= 3


@own
def test_description_and_model_agree(name: str) -> None:
    model, joints = mujoco.MjModel.from_xml_path(str(MODELS / f"{name}.xml")), described(name)["joints"]
    for joint, said in joints.items():
        motor = model.actuator(joint)
        assert model.joint(joint).range == pytest.approx(said["range"])
        assert motor.ctrlrange == pytest.approx(said["range"])
        assert motor.forcerange == pytest.approx([-said["effort"], said["effort"]])
        assert motor.user[0] > said["effort"], "a motor that stalls gives more than it gives for long"


@own
def test_it_weighs_and_measures_what_it_should(name: str) -> None:
    model, data = posed(name, "Stand")
    assert WEIGHTS[name][0] <= model.body_mass.sum() <= WEIGHTS[name][1]
    low, high = HEIGHTS[name]
    reach = np.array([min(size[size > 0]) for size in model.geom_size[1:]])
    assert low <= float((data.geom_xpos[1:, 2] + reach).max()) <= high
    for i in range(1, model.nbody):
        a, b, c = sorted(model.body_inertia[i])
        assert a + b >= c * 0.999, f"no solid has the inertia of {model.body(i).name}"
        assert a > 0


@own
def test_left_is_right_in_a_mirror(name: str) -> None:
    model = mujoco.MjModel.from_xml_path(str(MODELS / f"{name}.xml"))
    sides = [model.body(i).name for i in range(model.nbody) if model.body(i).name.startswith("left_")]
    assert sides
    for left in sides:
        right = "right_" + left.removeprefix("left_")
        assert model.body(left).mass == pytest.approx(model.body(right).mass)
        assert model.body(left).pos == pytest.approx(model.body(right).pos * [1, -1, 1])
        assert model.body(left).ipos == pytest.approx(model.body(right).ipos * [1, -1, 1], abs=1e-9)


@pytest.mark.parametrize(("name", "posture"), SAMPLES)
def test_it_stands_still_in_its_postures(name: str, posture: str) -> None:
    """The robot neither touches itself nor falls nor creeps, and no motor works at its limit."""
    model, data = posed(name, posture)
    floor = model.geom("floor").id
    assert not [contact for contact in data.contact if floor not in contact.geom], "it touches itself"
    start = data.xpos[1].copy()
    while data.time < SETTLED:
        mujoco.mj_step(model, data)
    settled, hardest = data.xpos[1].copy(), np.zeros(model.nu)
    while data.time < LONGER:
        mujoco.mj_step(model, data)
        hardest = np.maximum(hardest, np.abs(data.actuator_force))
    assert data.xmat[1][8] > 0.999, "it leans"
    assert np.abs(settled - start).max() < 0.005
    assert np.abs(data.xpos[1] - settled).max() < 0.0005
    assert np.abs(data.qvel).max() < 0.01
    assert (hardest < 0.5 * model.actuator_forcerange[:, 1]).all(), model.actuator(int(hardest.argmax())).name
    for joint, angle in described(name)["postures"][posture].items():
        assert data.qpos[model.joint(joint).qposadr[0]] == pytest.approx(angle, abs=0.02), joint


@own
def test_a_heavier_brother_is_heavier_in_all_its_parts(name: str) -> None:
    """These models define masses in geoms and their classes rather than in `inertial`."""
    document, _ = parse(f"models/{name}.yaml", (MODELS / f"{name}.yaml").read_bytes())
    assert document is not None
    body = build_body(document.data, DocumentReport(document), name=name)
    assert body is not None
    usual, heavy = (
        {one.body(i).name: one.body_mass[i] for i in range(one.nbody) if one.body(i).name.startswith("nao/")}
        for one in (physics(body, MODELS, "hall.xml", Variation(mass=factor)).model.ptr for factor in (1.0, 1.1))
    )
    assert heavy == pytest.approx({link: 1.1 * mass for link, mass in usual.items()})
    assert WEIGHTS[name][0] <= sum(usual.values()) <= WEIGHTS[name][1]
