"""models/nao.yaml, its schema, and the errors that a faulty body file causes."""

import json
from copy import deepcopy
from typing import Any

import jsonschema
import pytest

from lumen.language.robots import Body
from lumen.project.bodies import build_body
from lumen.project.document import Document
from lumen.project.document_report import DocumentReport
from lumen.project.yaml_reader import parse
from tests import ROOT
from tests.tables import for_each

NAOQI = [
    "HeadYaw", "HeadPitch", "LShoulderPitch", "LShoulderRoll", "LElbowYaw", "LElbowRoll", "LWristYaw", "LHand",
    "LHipYawPitch", "LHipRoll", "LHipPitch", "LKneePitch", "LAnklePitch", "LAnkleRoll", "RHipYawPitch", "RHipRoll",
    "RHipPitch", "RKneePitch", "RAnklePitch", "RAnkleRoll", "RShoulderPitch", "RShoulderRoll", "RElbowYaw",
    "RElbowRoll", "RWristYaw", "RHand",
]  # fmt: skip


def document() -> Document:
    found, diagnostics = parse("models/nao.yaml", (ROOT / "models/nao.yaml").read_bytes())
    assert found is not None
    assert not diagnostics
    return found


def build(data: Any) -> tuple[Body | None, list[str]]:
    report = DocumentReport(document())
    return build_body(data, report, name="nao"), [d.code for d in report.diagnostics]


def test_the_nao_is_described_as_the_schema_says() -> None:
    schema = json.loads((ROOT / "schemas/body.schema.json").read_text())
    jsonschema.Draft202012Validator.check_schema(schema)
    assert not list(jsonschema.Draft202012Validator(schema).iter_errors(document().data))


def test_the_nao_has_naoqi_s_joints_in_naoqi_s_order() -> None:
    body, codes = build(document().data)
    assert body is not None
    assert not codes
    assert list(body.joints) == NAOQI
    assert sorted(n for part in body.parts.values() for n in part) == sorted(NAOQI)
    assert body.tactile[:3] == ("RightBumper", "LeftBumper", "ChestButton")
    assert all(list(angles) == NAOQI for angles in body.postures.values())
    assert {"Stand", "StandInit", "StandZero", "Crouch"} <= body.postures.keys()


@for_each(
    ("path", "value", "code"),
    [
        (("joints", "HeadYaw", "range"), [1, -1], "empty-range"),
        (("parts", "head"), ["HeadYaw", "HeadPich"], "unknown-joint"),
        (("parts", "head"), ["HeadYaw", "HeadPitch", "LHand"], "joint-in-two-parts"),
        (("parts", "head"), ["HeadYaw"], "joint-without-part"),
        (("postures", "Stand"), {"HeadYaw": 0}, "incomplete-posture"),
        (("postures",), {}, "missing-key"),
        (("postures", "Stand", "HeadYaw"), 400, "angle-out-of-range"),
        (("postures", "Stand", "HeadYaw"), float("nan"), "angle-out-of-range"),
        (("coupled", 0, "rows"), [[1, 0, 1], [0, 0, 1]], "unsorted-rows"),
        (("shared",), {"RHipYawPitch": "Nose"}, "unknown-joint"),
    ],
)
def test_a_fault_is_named(path: tuple[Any, ...], value: Any, code: str) -> None:
    data = deepcopy(document().data)
    *above, last = path
    node = data
    for key in above:
        node = node[key]
    node[last] = value
    body, codes = build(data)
    assert body is not None
    assert code in codes


def test_degrees_are_turned_into_radians() -> None:
    data = deepcopy(document().data)
    data["units"] = {"angle": "deg", "length": "mm"}
    data["joints"] = {n: {"range": [-180, 90]} if "Hand" not in n else spec for n, spec in data["joints"].items()}
    body, _ = build(data)
    assert body is not None
    assert body.joints["HeadYaw"].minimum == pytest.approx(-3.14159, abs=1e-5)
    assert body.joints["LHand"].maximum == 1.0
    assert body.camera.position[0] == pytest.approx(0.05871e-3)
