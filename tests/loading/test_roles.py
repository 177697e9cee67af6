"""The roles of a body's parts: read from models/NAME.yaml, and reported at the word if they are unreadable."""

import pytest

import lumen
from lumen.language.diagnostics import Diagnostic
from lumen.language.robots import Body
from lumen.language.roles import JOINT_PATHS, Base, JointRole
from lumen.project.bodies import build_body, build_likes
from lumen.project.document_report import DocumentReport
from lumen.project.schema import check_schema
from lumen.project.yaml_reader import parse
from tests import ROOT
from tests.tables import for_each

SHIPPED = ROOT
GREETER = """\
units: {angle: deg, length: cm}
joints:
  Turn: {range: [-90, 90]}
  Bow: {range: [-20, 40]}
  Lift: {range: [-90, 90]}
  Grip: {range: [0, 1], opening: true}
parts: {head: [Turn, Bow], arms: [Lift, Grip]}
postures:
  Stand: {Turn: 0, Bow: 0, Lift: 0, Grip: 0}
roles:
  head: {yaw: {joint: Turn, reversed: true}, pitch: Bow}
  arms: {left: {shoulder-pitch: Lift}}
  hands: {left: Grip}
  base: {kind: wheels, left: LeftWheel, right: RightWheel, speed: 50, turn: 90}
"""


def read(text: str) -> tuple[Body | None, list[Diagnostic]]:
    document, broken = parse("models/greeter.yaml", text.encode())
    assert document is not None
    report = DocumentReport(document)
    body = build_body(check_schema(document, "body", report), report, name="greeter")
    return body, [*broken, *report.diagnostics]


def changed(*edits: str) -> str:
    text = GREETER
    for old, new in zip(edits[::2], edits[1::2], strict=True):
        assert text.count(old) == 1
        text = text.replace(old, new)
    return text


def test_a_body_on_wheels_needs_no_legs_no_camera_and_no_crouch() -> None:
    body, found = read(GREETER)
    assert found == []
    assert body is not None
    assert body.camera is None
    assert body.parts == {"head": ("Turn", "Bow"), "arms": ("Lift", "Grip"), "legs": (), "body": ()}
    assert body.roles.base == Base("wheels", "LeftWheel", "RightWheel", 0.5, pytest.approx(1.5707963))


def test_joints_are_found_by_role() -> None:
    body, _ = read(GREETER)
    assert body is not None
    assert list(body.roles.paths) == ["head.yaw", "head.pitch", "arms.left.shoulder-pitch", "hands.left"]
    assert body.roles.joint("head.yaw") == JointRole("Turn", reversed=True)
    assert body.roles.paths["head.yaw"].sign == -1.0
    assert body.roles.name("hands.left") == "Grip"
    assert body.roles.joint("legs.left.knee") is None
    assert body.roles.name("legs.left.knee") == ""


def test_every_joint_of_nao_has_a_role() -> None:
    body = lumen.load(SHIPPED).body
    assert {role.joint for role in body.roles.paths.values()} == set(body.joints)
    assert set(JOINT_PATHS) - set(body.roles.paths) == {
        "antennas.left", "antennas.right", "body.yaw", "head.roll", "head.x", "head.y", "head.z",
    }  # fmt: skip
    assert body.roles.base.kind == "biped"


def test_a_body_like_another_has_its_roles() -> None:
    document, _ = parse("models/v6.yaml", (SHIPPED / "models/v6.yaml").read_bytes())
    assert document is not None
    nao = lumen.load(SHIPPED).body
    found = build_likes({"nao": nao}, {"v6": (document.data, DocumentReport(document))}, ["nao", "v6"])
    assert found["v6"].name == "NAO V6"
    assert found["v6"].roles == nao.roles


def test_a_body_that_says_nothing_has_no_roles() -> None:
    body, found = read(GREETER[: GREETER.index("roles:")])
    assert found == []
    assert body is not None
    assert not body.roles.paths
    assert body.roles.base.kind == "fixed"


WRONG = {
    "an unknown joint": (["pitch: Bow}", "pitch: Bew}"], "11:53 unknown-joint did you mean `Bow`?"),
    "an unknown joint, reversed": (["{joint: Turn,", "{joint: Trun,"], "11:23 unknown-joint did you mean `Turn`?"),
    "an unknown role": (["shoulder-pitch", "sholder-pitch"], "12:17 unknown-key did you mean `shoulder-pitch`?"),
    "an unknown kind": (["kind: wheels", "kind: wheel"], "14:16 wrong-value did you mean `wheels`?"),
    "two roles of one joint": (
        ["pitch: Bow}", "pitch: Turn}"],
        "11:53 joint-in-two-roles give each joint one role only",
    ),
    "wheels that are nowhere": (["left: LeftWheel, ", ""], "14:16 incomplete-role name them under `roles`"),
    "wheels of no speed": (["speed: 50, ", ""], "14:3 missing-key"),
    "a speed of no wheels": (["wheels, left: LeftWheel, right: RightWheel, speed: 50,", "fixed,"], "14:23 unknown-key"),
    "a hand that turns": ([", opening: true", ""], "13:17 incomplete-role add `opening: true` to the joint `Grip`"),
    "eyes without a camera": (
        ["  hands:", "  eyes: {camera: Eye}\n  hands:"],
        "13:18 incomplete-role add `camera` with",
    ),
    "ears without a sonar": (
        ["  hands:", "  sensors: {sonar: {left: Ear}}\n  hands:"],
        "13:20 incomplete-role add `sonar` with its range and cone",
    ),
    "no posture to stand in": (["  Stand:", "  Stood:"], "8:1 missing-key every robot needs `Stand`"),
}


@for_each("what", WRONG)
def test_what_is_wrong_is_said_at_the_word(what: str) -> None:
    edits, expected = WRONG[what]
    _, found = read(changed(*edits))
    assert [f"{d.place.line}:{d.place.column} {d.code} {d.hint}"[: len(expected)] for d in found] == [expected]


def test_a_biped_is_told_all_that_it_lacks() -> None:
    base = "base: {kind: wheels, left: LeftWheel, right: RightWheel, speed: 50, turn: 90}"
    _, found = read(
        changed(base, "base: {kind: biped}\n  torso: Trunk\n  legs: {left: {knee: Bow}}", ", pitch: Bow", "")
    )
    lacks = next(d.message for d in found if d.code == "incomplete-role")
    for name in ("legs.left.hip-yaw", "legs.left.ankle-roll", "legs.right", "soles.left", "sensors.gyro"):
        assert f"`{name}`" in lacks
    assert "`legs.left.knee`" not in lacks
    assert "torso" not in lacks
    assert [d.code for d in found] == ["incomplete-role", "missing-key"]
