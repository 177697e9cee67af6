"""Imports of URDF and MJCF as body files: what is read, guessed and reported."""

from contextlib import suppress
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st

from lumen.cli.importing import result_faults
from lumen.features.formats_robots.importing import robot_body
from lumen.features.formats_robots.mjcf import mjcf_model
from lumen.features.formats_robots.reading import begins_robot, read_robot
from lumen.project.formats.conversion_findings import ConversionFindings, ForeignFileError
from lumen.project.formats.xml_elements import parse_xml
from tests import ROOT
from tests.tables import for_each

MODELS = ROOT / "models"
DM_CONTROL = Path(str(find_spec("dm_control").submodule_search_locations[0]))  # type: ignore[union-attr, index]
INERTIA = '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/>'
LINK = f'<link name="{{}}"><inertial><mass value="1"/>{INERTIA}</inertial></link>'
LIMIT = '<limit lower="-1" upper="1.5" velocity="3" effort="2"/>'


def urdf(*joints: str, extra: str = "", links: str = "abc") -> bytes:
    """Return a URDF robot with links a, b, c and these joints, each on a line of its own from line 3 on."""
    return "\n".join(['<robot name="r">', "".join(map(LINK.format, links)) + extra, *joints, "</robot>"]).encode()


def joint(
    name: str, inner: str = LIMIT, kind: str = "revolute", parent: str = "a", child: str = "b", axis: str = "0 0 1"
) -> str:
    ends = f'<parent link="{parent}"/><child link="{child}"/><axis xyz="{axis}"/>'
    return f'<joint name="{name}" type="{kind}">{ends}{inner}</joint>'


def imported(content: bytes) -> tuple[dict[str, Any], list[str]]:
    """Return the data of the body, and the line and message of each finding."""
    text, found = read_robot("r.urdf", content, "r", "r.xml")
    assert not result_faults("r.yaml", text, "body")
    return yaml.safe_load(text), [f"{d.place.line}: {d.message}" for d in found]


@pytest.mark.parametrize("name", ["greeter", "sprout", "nao"])
def test_roles_of_our_own_bodies_are_guessed_as_they_are(name: str) -> None:
    text, _ = read_robot(f"{name}.xml", (MODELS / f"{name}.xml").read_bytes(), name, f"{name}.xml")
    guessed, known = yaml.safe_load(text)["roles"], yaml.safe_load((MODELS / f"{name}.yaml").read_text())["roles"]
    for role in ("torso", "head", "eyes", "arms", "legs", "soles"):
        if name == "nao" and role == "legs":  # the axis of its hips lies between yaw and pitch
            assert guessed[role]["left"].pop("hip-yaw") == {"joint": "LHipYawPitch", "reversed": True}
            del known[role]["left"]["hip-yaw"]
        assert guessed.get(role) == known.get(role), role
    assert guessed["base"]["kind"] == known["base"]["kind"]
    assert {side: guessed["base"].get(side) for side in ("left", "right")} == {
        side: known["base"].get(side) for side in ("left", "right")
    }
    assert "# guessed" in text


@pytest.mark.parametrize(
    "file",
    [
        "locomotion/walkers/assets/humanoid_CMU_V2020.xml",
        "locomotion/walkers/assets/rodent.xml",
        "suite/humanoid.xml",
        "suite/dog.xml",
        "suite/quadruped.xml",
        "third_party/kinova/jaco_arm.xml",
        "third_party/ant/ant.xml",
    ],
)
def test_joints_stand_where_mujoco_has_them(file: str) -> None:
    """Places, axes and limits of every hinge agree with MuJoCo's, in models that others made."""
    path = DM_CONTROL / file
    ours = mjcf_model(parse_xml(file, path.read_bytes()), file, ConversionFindings())
    spec = mujoco.MjSpec.from_file(str(path))
    model = spec.compile()
    data = mujoco.MjData(model)
    for j in range(model.njnt):
        if model.jnt_type[j] == mujoco.mjtJoint.mjJNT_HINGE:
            data.qpos[model.jnt_qposadr[j]] = 0.0
    mujoco.mj_kinematics(model, data)
    hinges = {
        model.joint(j).name: j
        for j in range(model.njnt)
        if model.jnt_type[j] == mujoco.mjtJoint.mjJNT_HINGE and model.joint(j).name
    }
    assert {j.name for j in ours.joints} == hinges.keys()
    for mine in ours.joints:
        j = hinges[mine.name]
        assert mine.axis / np.linalg.norm(mine.axis) == pytest.approx(data.xaxis[j], abs=1e-5), mine.name
        assert mine.position == pytest.approx(data.xanchor[j], abs=1e-5), mine.name
        if model.jnt_limited[j]:
            assert (mine.low, mine.high) == pytest.approx(tuple(model.jnt_range[j])), mine.name
        else:
            assert mine.low is None


def test_a_joint_of_urdf_keeps_limits_speed_and_torque() -> None:
    body, told = imported(urdf(joint("head_pan"), joint("head_tilt", parent="b", child="c", axis="0 -1 0")))
    assert body["joints"]["head_pan"] == {"range": [-1, 1.5], "speed": 3, "effort": 2}
    assert body["roles"]["head"] == {"yaw": "head_pan", "pitch": {"joint": "head_tilt", "reversed": True}}
    assert body["parts"]["head"] == ["head_pan", "head_tilt"]
    assert body["motors"] == {"give": 0.1}
    assert not told


@for_each(
    ("joints", "line", "words"),
    [
        ([joint("x", inner="", kind="continuous")], 3, "`x` has no limits"),
        ([joint("x", inner="", kind="continuous")], 3, "`x` has no torque in the model"),
        (
            [joint("x"), joint("y", LIMIT + '<mimic joint="x" multiplier="2"/>', child="c")],
            4,
            "with a factor or an offset",
        ),
        ([joint("x"), joint("y", kind="prismatic", child="c")], 4, "`y` has the type `prismatic`"),
        ([joint("x"), joint("y", kind="floating", child="c")], 4, "`y` has the type `floating`"),
        ([joint("x"), joint("y", child="nobody")], 4, "has the child `nobody`, which does not exist"),
        ([joint("x"), '<joint name="y" type="revolute"/>'], 4, "has no parent"),
        ([joint("x"), joint("y", parent="b", child="b")], 4, "is the child of two joints"),
        ([joint("x"), joint("y", parent="c")], 4, "`b` is the child of two joints"),
        ([joint("x"), joint("y", parent="b", child="a")], 4, ""),
        (
            [joint("x"), joint("y", '<limit lower="2" upper="1" effort="1"/>', child="c")],
            4,
            "the range from 2 to 1 is empty",
        ),
        ([joint("x"), joint("y", '<limit lower="low" upper="1" effort="1"/>', child="c")], 4, 'lower="low"'),
        ([joint("x"), joint("y", '<limit lower="nan" upper="1e999" effort="1"/>', child="c")], 4, 'lower="nan"'),
        ([joint("x"), joint("y/z", child="c")], 4, "the name of the joint `y/z` is not allowed"),
        ([joint("x"), joint("x", child="c")], 4, "a second joint is named `x`"),
    ],
)
def test_what_a_body_has_no_word_for_is_told_with_its_line(joints: list[str], line: int, words: str) -> None:
    _, told = imported(urdf(*joints))
    assert any(said.startswith(f"{line}: ") and words in said for said in told) or not words, told


def test_a_joint_that_equals_another_shares_its_motor() -> None:
    hip = [joint("l_hip_yaw"), joint("r_hip_yaw", LIMIT + '<mimic joint="l_hip_yaw"/>', child="c")]
    body, _ = imported(urdf(*hip, '<transmission name="t"><type>x</type></transmission>', "<gazebo/>"))
    assert body["shared"] == {"r_hip_yaw": "l_hip_yaw"}


def test_legs_without_soles_are_told_what_walking_needs() -> None:
    body, told = imported(urdf(joint("left_knee", axis="0 1 0"), joint("right_knee", child="c", axis="0 1 0")))
    assert body["roles"]["base"] == {"kind": "fixed"}
    assert any("lacks parts that walking needs" in said for said in told)


@for_each(
    ("content", "words"),
    [
        (b"", "no element found"),
        (b"<robot", "unclosed token"),
        (b'<robot name="r"/>', "no named joint that turns"),
        (b"<sdf/>", "begins with <sdf>"),
        (b'<!DOCTYPE x [<!ENTITY a "b">]><robot name="&a;"/>', "document type"),
        (b"<robot>" + b"<a>" * 200 + b"</a>" * 200 + b"</robot>", "100 levels"),
        (b"<robot>" + b"<joint/>" * 2_000 + b"</robot>", "more than 1,000 joints"),
        (b"<robot>" + b"<a/>" * 60_000 + b"</robot>", "50,000 elements"),
        (b"<mujoco>" + b" " * 5_000_000 + b"</mujoco>", "5 MB"),
        ((MODELS / "hall.xml").read_bytes(), "no named joint that turns"),
    ],
)
def test_what_is_no_robot_is_refused_in_a_line(content: bytes, words: str) -> None:
    with pytest.raises(ForeignFileError) as error:
        read_robot("r.urdf", content, "r", "r.xml")
    assert words in str(error.value)


def test_a_robot_is_known_by_its_first_element() -> None:
    assert begins_robot(b'\xef\xbb\xbf<?xml version="1.0"?>\n<!-- a > b -->\n<robot name="r">')
    assert begins_robot(b"<mujoco>")
    assert not begins_robot(b"<scxml><robot/></scxml>")
    assert not begins_robot(b"<robots>")
    assert not begins_robot(b"<!--" * 20_000)


def test_a_urdf_becomes_the_mjcf_that_its_body_names(tmp_path: Path) -> None:
    """Meshes that MuJoCo reads are included under a new name; others are reported, and the rest is converted
    nevertheless.
    """
    cube = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
    (tmp_path / "meshes").mkdir()
    (tmp_path / "meshes" / "my cube.obj").write_text(cube)
    shape = '<link name="c"><visual><geometry><mesh filename="package://r/meshes/{}"/></geometry></visual></link>'
    box = '<link name="d"><collision><geometry><box size="1 1 1"/></geometry></collision></link>'
    content = urdf(
        joint("head_pan"), joint("x", child="c"), joint("y", child="d", kind="fixed"), joint("z", child="e"),
        shape.format("my cube.obj"), shape.format("gone.stl").replace('"c"', '"e"'), box, links="ab",
    )  # fmt: skip
    (tmp_path / "r.urdf").write_bytes(content)
    text, told, beside = robot_body(tmp_path / "r.urdf", content, tmp_path / "models" / "rob.yaml", "rob")
    assert [f"{d.place.line}: {d.message}"[:41] for d in told if "mesh" in d.message] == [
        "8: the mesh `package://r/meshes/gone.stl`"
    ]
    for path, written in beside.items():
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(written)
    assert {path.relative_to(tmp_path / "models").as_posix() for path in beside} == {"rob.xml", "rob/my_cube.obj"}
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "models" / "rob.xml"))
    assert yaml.safe_load(text)["mjcf"] == "rob.xml"
    assert model.joint("head_pan").range == pytest.approx([-1, 1.5])
    assert model.nmesh == 1


def test_a_urdf_that_mujoco_can_t_build_has_a_body_all_the_same(tmp_path: Path) -> None:
    content = urdf(joint("head_pan"), joint("x", child="c"), '<link name="a"/>')
    text, told, beside = robot_body(tmp_path / "r.urdf", content, tmp_path / "rob.yaml", "rob")
    assert not beside
    assert any("rob.xml was not written: MuJoCo cannot build it" in d.message for d in told)
    assert "head_pan" in text


WHOLE = urdf(
    joint("head_pan"),
    joint("left_wheel", kind="continuous", child="c", axis="0 1 0"),
    '<link name="d"><visual><origin xyz="0 0 1" rpy="1 0 0"/><geometry><sphere radius="1"/></geometry></visual></link>',
    joint("r_knee", LIMIT + '<mimic joint="head_pan"/>', child="d"),
)
WORDS = [
    b'"',
    b"<",
    b">",
    b"/",
    b"-1",
    b"1e308",
    b"nan",
    b"0",
    b"a",
    b"joint",
    b"link",
    b"fixed",
    b"\x00",
    b"\xff",
    b" ",
]


@settings(max_examples=100, deadline=None)
@given(
    whole=st.sampled_from([WHOLE, (MODELS / "lantern.xml").read_bytes()]),
    damage=st.lists(st.tuples(st.floats(0, 1), st.integers(0, 30), st.sampled_from(WORDS)), max_size=4),
)
def test_a_damaged_robot_is_read_or_refused(whole: bytes, damage: list[tuple[float, int, bytes]]) -> None:
    """After any cuts and insertions the result is a body that Lumen's own loader accepts, or a one-line error."""
    for where, cut, word in damage:
        at = int(where * len(whole))
        whole = whole[:at] + word + whole[at + cut :]
    with suppress(ForeignFileError):
        text, told, _ = robot_body(Path("r.urdf"), whole, Path("/nowhere/models/r.yaml"), "r")
        faults = result_faults("r.yaml", text, "body")
        assert not faults, faults
        assert all(d.place.line for d in told)
