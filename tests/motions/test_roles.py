"""Motions by role: the same file moves other bodies, as far as they have what it names."""

from dataclasses import replace

import pytest

from lumen.language.diagnostics import Diagnostic
from lumen.language.mirrors import mirror_of
from lumen.language.motions import MotionDefinition
from lumen.language.robots import Body, Joint
from lumen.language.roles import JointRole, Roles
from lumen.project.document_report import DocumentReport
from lumen.project.life import build_gestures, build_life
from lumen.project.motions import build_motion
from lumen.project.schema import check_schema
from lumen.project.yaml_reader import parse
from tests.motions.making import made, nao

GREETER = Body(
    "greeter",
    "greeter.xml",
    {name: Joint(name, -1.0, 1.0) for name in ("Turn", "Lift", "Raise")},
    {"head": ("Turn",), "arms": ("Lift", "Raise"), "legs": ()},
    {"Stand": {"Turn": 0.0, "Lift": 0.0, "Raise": 0.0}},
    (),
    None,
    (),
    roles=Roles(
        head={"yaw": JointRole("Turn", reversed=True)},
        arms={
            "left": {"shoulder-pitch": JointRole("Lift"), "elbow-roll": JointRole("Raise")},
            "right": {"shoulder-pitch": JointRole("Grow")},
        },
    ),
)
SHARED = """\
units: {angle: deg}
keyframes:
  - {at: 1s, roles: {head.yaw: 20, head.pitch: 10, arms.left.shoulder-pitch: 30}, hands: {left: 1}}
  - {at: 2s, roles: {head.yaw: 0}, hands: {left: 0}}
"""


def read(text: str, body: Body, kind: str = "motion") -> tuple[object, list[Diagnostic]]:
    document, broken = parse("motions/shared.yaml", text.encode())
    assert document is not None
    report = DocumentReport(document)
    data = check_schema(document, kind, report)
    build = {"motion": build_motion, "life": build_life, "gestures": build_gestures}[kind]
    return build(data, report, name="shared", body=body), [*broken, *report.diagnostics]  # type: ignore[operator]


def motion(text: str, body: Body) -> tuple[MotionDefinition, list[str]]:
    found, said = read(text, body)
    assert isinstance(found, MotionDefinition)
    return found, [f"{d.place.line}:{d.place.column} {d.code} {d.message}" for d in said]


def test_roles_are_nao_s_joints() -> None:
    by_name = made(
        SHARED.replace("roles", "joints")
        .replace("head.yaw", "HeadYaw")
        .replace("head.pitch", "HeadPitch")
        .replace("arms.left.shoulder-pitch", "LShoulderPitch")
    )
    assert motion(SHARED, nao()) == (replace(by_name, name="shared"), [])


def test_another_body_does_what_it_can_and_says_once_what_it_leaves_out() -> None:
    found, said = motion(SHARED, GREETER)
    assert found.tracks.keys() == {"Turn", "Lift"}
    assert found.tracks["Turn"][0].angle == pytest.approx(-0.349066)  # its angle grows to the right
    assert said == ["3:36 left-out greeter has no `head.pitch`, `hands.left`, so this motion can't move them"]


def test_a_joint_that_can_not_go_so_far_stops_at_its_limit() -> None:
    found, said = motion(SHARED.replace("head.yaw: 20", "head.yaw: 80").replace("head.pitch: 10, ", ""), GREETER)
    assert found.tracks["Turn"][0].angle == -1.0
    assert said[0] == "3:32 out-of-reach greeter can't bring `head.yaw` to 80 deg: it stops at its limit"


def test_joints_go_before_roles() -> None:
    text = "keyframes:\n  - {at: 1s, roles: {head.yaw: 0.5}, joints: {Turn: 0.1}}\n"
    found, said = motion(text, GREETER)
    assert not said
    assert found.tracks["Turn"][0].angle == 0.1


def test_handles_and_trails_take_roles() -> None:
    text = (
        "interpolation: bezier\ntrails: {head.yaw: 100ms}\nkeyframes:\n"
        "  - {at: 1s, roles: {head.yaw: 0.5}, handles: {head.yaw: {in: {before: 200ms, angle: 0.1}}}}\n"
        "  - {at: 3s, roles: {head.yaw: 0.0}}\n"
    )
    found, said = motion(text, GREETER)
    assert not said
    assert found.tracks["Turn"][0].handle_in == (-0.2, pytest.approx(-0.1))
    assert found.tracks["Turn"][0].time == pytest.approx(1.1)


def test_a_mirror_knows_roles_and_drops_what_has_no_other_side() -> None:
    mirror = mirror_of(GREETER)
    assert mirror == {
        "Turn": ("Turn", -1.0),
        "Lift": ("Grow", 1.0),
        "Grow": ("Lift", 1.0),
        "Raise": ("", 1.0),
    }
    found, _ = motion("mirror: true\nkeyframes:\n  - {at: 1s, joints: {Turn: 0.5, Raise: 0.2}}\n", GREETER)
    assert {joint: keys[0].angle for joint, keys in found.tracks.items() if keys[0].time == 1.0} == {"Turn": -0.5}


@pytest.mark.parametrize(("joint", "sides"), [("Turn", False), ("Raise", False), ("Lift", True)])
def test_only_a_joint_of_one_side_may_have_been_meant_the_other_way(joint: str, sides: bool) -> None:
    body = replace(GREETER, joints={name: Joint(name, -1.5, 0.5) for name in GREETER.joints})
    _, said = read(f"keyframes:\n  - {{at: 1s, joints: {{{joint}: 1.0}}}}\n", body)
    assert [d.code for d in said] == ["angle-out-of-range"]
    assert said[0].hint.startswith("left and right joints turn in opposite directions: write -1") is sides


def test_styles_and_gestures_leave_out_what_a_body_lacks() -> None:
    style = "sways:\n  it: {period: 4s, roles: {head.yaw: 0.02, legs.left.knee: 0.01}}\n"
    found, said = read(style, GREETER, "life")
    assert found.sways[0].joints == {"Turn": -0.02}  # type: ignore[attr-defined]
    assert [d.code for d in said] == ["left-out"]
    gestures = "gestures:\n  nod: {for: beat, stroke: {takes: 400ms, roles: {head.yaw: 0.2, head.pitch: 0.1}}}\n"
    library, said = read(gestures, GREETER, "gestures")
    assert library.gestures[0].tracks.keys() == {"Turn"}  # type: ignore[attr-defined]
    assert [d.code for d in said] == ["left-out"]


@pytest.mark.parametrize(
    ("kind", "text"),
    [("life", "sways:\n  it: {period: 4s}\n"), ("gestures", "gestures:\n  nod: {for: beat, stroke: {takes: 1s}}\n")],
)
def test_what_moves_nothing_is_told(kind: str, text: str) -> None:
    _, said = read(text, GREETER, kind)
    assert [d.code for d in said] == ["missing-key"]
