"""Bodies of other tools from public bug reports: omitted parts are listed, and roles follow the joints."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import yaml

import lumen
from lumen.cli.main import main
from lumen.features.formats_robots.reading import read_robot
from lumen.language.commands import Look
from lumen.language.diagnostics import Diagnostic
from lumen.language.mirrors import mirror_of
from lumen.language.roles import JointRole
from lumen.language.skills import lack_of
from lumen.project.bodies import build_body
from lumen.project.document_report import DocumentReport
from lumen.project.formats.conversion_findings import LOST, ForeignFileError
from lumen.project.motions import build_motion
from lumen.project.packaged import shipped_root
from lumen.project.schema import check_schema
from lumen.project.yaml_reader import parse
from tests.tables import for_each

INPUTS = Path(__file__).parent / "inputs" / "motions"
BODY = lumen.load(shipped_root()).body


def robot(name: str, *changes: tuple[str, str]) -> tuple[dict[str, Any], list[Diagnostic]]:
    """Import an input file after some changes to its text; return the body file and the findings."""
    text = (INPUTS / name).read_text("utf-8")
    for old, new in changes:
        assert old in text, old
        text = text.replace(old, new)
    body, found = read_robot(name, text.encode(), "robot", "robot.xml")
    document, faults = parse("robot.yaml", body.encode())
    assert document is not None
    report = DocumentReport(document)
    build_body(check_schema(document, "body", report), report, name="imported")
    assert [d for d in (*faults, *report.diagnostics) if d.severity == "error"] == []
    return yaml.safe_load(body), found


def test_a_name_with_a_dash_is_a_joint() -> None:
    body, found = robot("dash.urdf")
    assert list(body["joints"]) == ["head-yaw"]
    assert body["roles"]["head"] == {"yaw": "head-yaw"}
    assert found == []


@for_each("name", ["head/yaw", "1_yaw", "head yaw", "höhe"])
def test_a_name_that_can_not_be_written_is_named(name: str) -> None:
    with pytest.raises(ForeignFileError, match=f"the name of the joint `{name}` is not allowed"):
        robot("dash.urdf", ("head-yaw", name))


@for_each(
    ("mimic", "polycoef"),
    [
        ('multiplier="-1" offset="0"', "0 -1 0 0 0"),
        ('multiplier="-0.5" offset="0.2"', "0.2 -0.5 0 0 0"),
        ('offset="-0.1"', "-0.1 1 0 0 0"),
    ],
)
def test_a_joint_that_follows_with_a_factor_has_no_motor(
    mimic: str, polycoef: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    change = ('multiplier="-1" offset="0"', mimic)
    body, found = robot("mimic-factor.urdf", change)
    assert list(body["joints"]) == ["finger_joint"]
    assert "shared" not in body
    assert [(d.code, d.place.line) for d in found] == [("carried-over-differently", 7)]
    text = (INPUTS / "mimic-factor.urdf").read_text("utf-8").replace(*change)
    (tmp_path / "gripper.urdf").write_text(text, "utf-8")
    assert main(["import", str(tmp_path / "gripper.urdf"), "-o", str(tmp_path / "robot.yaml")]) == 0
    capsys.readouterr()
    model = (tmp_path / "robot.xml").read_text("utf-8")
    pair = f'joint1="right_finger_joint" joint2="finger_joint" polycoef="{polycoef}"'
    assert pair in model


def test_an_equality_of_a_model_with_a_factor_has_no_motor_either() -> None:
    arm = '<body><joint name="{0}" range="0 1"/><geom size="1"/></body>'
    model = (
        '<mujoco><compiler angle="radian"/><worldbody>' + arm.format("a") + arm.format("b") + "</worldbody><actuator>"
        '<position name="a" joint="a" forcerange="-1 1"/></actuator><equality>{}</equality></mujoco>'
    )
    for pair, joints, said in (
        ('<joint joint1="b" joint2="a" polycoef="0 -1"/>', ["a"], ["`b` follows `a`"]),
        (
            '<joint joint1="b" joint2="a" polycoef="0 -1 0 0 0" active="false"/>',
            ["a", "b"],
            ["`b` has no torque in the model"],
        ),
        ('<joint joint1="b" joint2="a" polycoef="0 x"/>', ["a", "b"], ["`polycoef="]),
    ):
        body, found = read_robot("m.xml", model.replace("{}", pair).encode(), "m", "m.xml")
        assert list(yaml.safe_load(body)["joints"]) == joints
        assert all(any(d.message.startswith(words) for d in found) for words in said), found


@for_each(
    ("old", "new", "message"),
    [
        ('upper="1.5"', 'uper="1.5"', "`uper` of `<limit>` is left out"),
        ("<cylinder ", '<cylinder size="1 1 1" ', "`size` of `<cylinder>` is left out"),
        ('cylinder length="0.05" radius', 'sphere size="0.1" radius', "`size` of `<sphere>` is left out"),
        ('cylinder length="0.05" radius="0.08"', 'box size="1 1 1" radius="0.08"', "`radius` of `<box>` is left out"),
        ("<limit", "<limits/><limit", "`<limits>` in `<joint>` is left out"),
        ("<axis", '<safety_controller soft_lower_limit="-1"/><axis', "`<safety_controller>` in `<joint>` is left out"),
        ('<mass value="1"/>', '<mas value="1"/>', "`<mas>` in `<inertial>` is left out"),
        ('ixx="0.01"', 'ix="0.01"', "`ix` of `<inertia>` is left out"),
        ("</robot>", "<mujoco/></robot>", "`<mujoco>` in `<robot>` is left out"),
        ("</robot>", "<sensor/></robot>", "`<sensor>` in `<robot>` is left out"),
        ('type="revolute"', 'typ="revolute"', "`typ` of `<joint>` is left out"),
    ],
)
def test_unread_parts_of_a_urdf_are_listed(old: str, new: str, message: str) -> None:
    extra = (
        '<joint name="x" type="continuous"><parent link="base_link"/><child link="x"/><limit effort="1" velocity="1"/>'
    )
    text = (INPUTS / "dash.urdf").read_text("utf-8").replace(old, new, 1)
    text = text.replace("</robot>", f'<link name="x"/>{extra}</joint></robot>')
    _, found = read_robot("r.urdf", text.encode(), "r", "r.xml")
    assert message in [d.message for d in found]


@for_each(
    ("old", "new", "message"),
    [
        ("range=", "rang=", "`rang` of `<joint>` is left out"),
        ('angle="radian"', 'angle="radians"', "`angle` is `radians`: it is read as `degree`"),
        ("<compiler", '<compiler autolimits="yes"', "`autolimits` is `yes`: it is read as `true`"),
        ('limited="true"', 'limited="yes"', "`limited` is `yes`: it is read as `auto`"),
        ('joint class="arm"', 'joint class="amr"', "the class `amr` does not exist"),
        ("<site", "<sight", "`<sight>` in `<body>` is left out"),
        ("forcerange=", "forcrange=", "`forcrange` of `<position>` is left out"),
        ("<gyro", "<giro", "`<giro>` in `<sensor>` is left out"),
        ("<worldbody>", "<worldbody gravity='0'>", "`gravity` of `<worldbody>` is left out"),
        ('type="hinge"', 'type="hing"', "the joint `a` is a `hing`: only joints that turn are imported"),
    ],
)
def test_unread_parts_of_a_model_are_listed(old: str, new: str, message: str) -> None:
    joint = '<joint class="arm" type="hinge" limited="true" name="a" range="0 1"/><joint name="b" range="0 1"/>'
    model = (
        '<mujoco><compiler angle="radian"/><default><default class="arm"><joint axis="0 0 1"/></default></default>'
        f'<worldbody><body name="c">{joint}<site name="s"/><geom size="1"/></body></worldbody><actuator>'
        '<position name="a" joint="a" forcerange="-1 1"/></actuator><sensor><gyro name="g" site="s"/></sensor></mujoco>'
    )
    _, before = read_robot("m.xml", model.encode(), "m", "m.xml")
    assert not any(d.code == LOST and "torque" not in d.message for d in before)
    _, found = read_robot("m.xml", model.replace(old, new, 1).encode(), "m", "m.xml")
    assert message in [d.message for d in found]


def test_a_head_that_rolls_is_turned_round_by_a_mirror() -> None:
    bodies = Path(shipped_root()) / "models" / "lantern.yaml"
    document, _ = parse("models/lantern.yaml", bodies.read_bytes())
    assert document is not None
    report = DocumentReport(document)
    lantern = build_body(check_schema(document, "body", report), report, name="lantern")
    assert lantern is not None
    assert mirror_of(lantern)["tilt"] == ("tilt", -1.0)
    for name in ("dance", "sing"):
        file = f"motions/lantern/{name}.yaml"
        written, _ = parse(file, (Path(shipped_root()) / file).read_bytes())
        assert written is not None
        said = DocumentReport(written)
        motion = build_motion(check_schema(written, "motion", said), said, name=name, body=lantern)
        assert motion is not None
        angles = [key.angle for key in motion.tracks["tilt"]]
        assert min(angles) == pytest.approx(-max(angles), abs=0.03)
        assert max(angles) > 0.1


def test_a_head_that_only_rolls_can_not_look() -> None:
    rolls = replace(BODY, roles=replace(BODY.roles, head={"roll": JointRole("HeadYaw")}))
    assert lack_of(Look(0.1, 0.0), rolls) is not None
    assert lack_of(Look(0.1, 0.0), BODY) is None


@for_each(
    ("motor", "told"),
    [
        ('<position joint="HeadYaw" ctrlrange="-1 1"/>', ["-57.3 to 57.3 deg"]),
        ('<position joint="HeadYaw" ctrlrange="-3 3" gear="3"/>', ["-57.3 to 57.3 deg"]),
        ('<position joint="HeadYaw" ctrlrange="-1 1" ctrllimited="false"/>', []),
        ('<position joint="HeadYaw" ctrlrange="-90 90"/>', []),
        ('<motor joint="HeadYaw" ctrlrange="-1 1"/>', []),
    ],
)
def test_a_servo_with_less_than_its_joints_range_is_reported(motor: str, told: list[str]) -> None:
    body = '<body><joint name="HeadYaw" range="-90 90"/><geom size="1"/></body>'
    text = f"<mujoco><worldbody>{body}</worldbody><actuator>{motor}</actuator></mujoco>"
    found = read_robot("head.xml", text.encode(), "head", "head.xml")[1]
    assert [d.message.split("from ")[1] for d in found if "turns it only from" in d.message] == told


@for_each(
    ("name", "gear", "told"),
    [("HeadYaw", "-1", ["-1"]), ("HeadYaw", "2 0 0", ["2"]), ("HeadYaw", "1", []), ("turn", "-1", [])],
)
def test_a_servo_with_a_gear_is_reported(name: str, gear: str, told: list[str]) -> None:
    body = '<body><joint name="HeadYaw" range="-90 90"/><geom size="1"/></body>'
    motor = f'<position name="{name}" joint="HeadYaw" gear="{gear}"/>'
    text = f"<mujoco><worldbody>{body}</worldbody><actuator>{motor}</actuator></mujoco>"
    found = read_robot("head.xml", text.encode(), "head", "head.xml")[1]
    assert [d.message.split("`gear` of ")[1].split(":")[0] for d in found if "`gear`" in d.message] == told
