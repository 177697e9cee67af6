"""Motions and bodies from public bug reports: each keeps its numbers, and omitted parts are listed."""

import gc
from dataclasses import replace
from math import degrees, radians
from pathlib import Path
from typing import Any

import pytest
import yaml

import lumen
from lumen.cli.main import main
from lumen.features.formats_robots.reading import read_robot
from lumen.language.commands import Look, Wake
from lumen.language.diagnostics import Diagnostic
from lumen.language.events import Event
from lumen.language.mirrors import mirror_of
from lumen.language.motions import Cue, Interpolation, Keyframe, MotionDefinition
from lumen.language.robots import Body
from lumen.language.roles import JointRole
from lumen.language.skills import lack_of
from lumen.lint import check_files
from lumen.motion import bounds
from lumen.motion.bounds import within_limits
from lumen.motion.limits import beyond_limits, overspeed
from lumen.ports import Aim, Perform, RobotCommand, Sense
from lumen.project.bodies import build_body
from lumen.project.document_report import DocumentReport
from lumen.project.formats.conversion_findings import LOST, ForeignFileError
from lumen.project.formats.imported_motions import read_gesture
from lumen.project.motions import build_motion
from lumen.project.packaged import shipped_root
from lumen.project.schema import check_schema
from lumen.project.yaml_reader import parse
from lumen.statechart import VirtualClock
from tests.tables import for_each

INPUTS = Path(__file__).parent / "inputs" / "motions"
BODY = lumen.load(shipped_root()).body


def read(name: str, old: str = "", new: str = "", timeline: str = "") -> tuple[list[dict[str, Any]], list[Diagnostic]]:
    """Read an input file with `old` replaced by `new`; return the keyframes and the findings."""
    text = (INPUTS / (name if name.endswith(".xar") else f"{name}.txt")).read_text("utf-8")
    assert old in text, old
    data, found = read_gesture(name, text.replace(old, new).encode(), BODY, timeline=timeline)
    return [{"at": frame["at"], **frame["joints"]} for frame in data["keyframes"]], found


WAVE = [{"at": "1s", "RShoulderPitch": 30, "RHand": 0.9}, {"at": "2s", "RShoulderPitch": 80, "RHand": 0.1}]


@for_each(
    ("name", "old", "new"),
    [
        ("hand-without-unit.xar", "", ""),
        ("hand-without-unit.xar", 'actuator="RHand"', 'actuator="RHand" unit="0"'),
        ("hand-without-unit.xar", 'actuator="RHand"', 'actuator="RHand" unit="-1"'),
        ("box-library.xar", 'unit="1"', 'unit="0"'),
    ],
)
def test_a_hand_is_an_opening_with_any_unit(name: str, old: str, new: str) -> None:
    keys, found = read(name, old, new)
    assert keys == WAVE
    assert [d.message[:18] for d in found] == (["`unit` of `RHand` i"[:18]] if "unit" in new else [])


def test_an_arm_stays_in_degrees_with_any_unit() -> None:
    keys, found = read("box-library.xar", 'unit="0"', 'unit="1"')
    assert keys == WAVE
    assert "keys are read as an angle in degrees" in found[0].message


def test_keys_behind_the_end_flag_are_not_played() -> None:
    keys, found = read("end-flag.xar")
    assert keys == WAVE[:1]
    assert [d.code for d in found] == ["carried-over-differently"] * 2
    assert read("end-flag.xar", 'end_frame="30"', 'end_frame="50"') == (WAVE, [])


def test_keys_before_the_start_flag_are_not_played() -> None:
    keys, found = read("box-library.xar", 'start_frame="1"', 'start_frame="26"')
    assert keys == [{"at": "1s", "RShoulderPitch": 80, "RHand": 0.1}]
    assert ["Start flag" in d.message for d in found] == [True, True]


@for_each(("flag"), ['start_frame="x"', 'start_frame="-4"', 'end_frame="0"', 'end_frame=""', 'end_frame="nan"'])
def test_a_flag_that_is_no_frame_is_listed(flag: str) -> None:
    name = flag.partition("=")[0]
    keys, found = read("box-library.xar", f'{name}="{"1" if name[0] == "s" else "-1"}"', flag)
    assert keys == WAVE
    assert [(d.code, d.message.split()[0], d.place.line) for d in found] == [(LOST, f"`{name}`", 4)]


def test_a_library_of_boxes_is_a_project() -> None:
    assert read("box-library.xar") == (WAVE, [])


def test_a_muted_curve_without_a_key_loses_nothing() -> None:
    assert read("muted-empty.xar") == (WAVE, [])
    _, found = read("muted-empty.xar", 'unit="-1" />', 'unit="0"><Key frame="5" value="1" /></ActuatorCurve>')
    assert [d.message for d in found] == ["`HeadYaw` is muted"]


@for_each(
    ("old", "new", "message"),
    [
        ("<ActuatorList", "<Music/><ActuatorList", "`<Music>` in `<Timeline>` is left out"),
        ('fps="25"', 'fps="25" loop="1"', "`loop` of `<Timeline>` is left out"),
        ('mute="0"', 'muted="0"', "`muted` of `<ActuatorCurve>` is left out"),
        ('<Key frame="25"', '<Key speed="2" frame="25"', "`speed` of `<Key>` is left out"),
        ('mute="0"', 'mute="true"', "`mute` of `RShoulderPitch` is `true`: it is read as 0"),
        ('enable="1"', 'enable="yes"', "`enable` is `yes`: the timeline is read as switched on"),
        ('xar_version="3"', 'xar_version="4"', "`xar_version` is 4: the file is read as version 3"),
        (
            'value="30" />',
            'value="30"><Tangent side="left" interpType="bezir" abscissaParam="-1" /></Key>',
            "unknown interpolation `bezir` for `RShoulderPitch`",
        ),
        (
            'value="30" />',
            'value="30"><Tangent side="middle" interpType="linear" /></Key>',
            "a tangent of `RShoulderPitch` has the side `middle`",
        ),
        (
            '<Box name="root" id="-1">',
            '<Box name="root" id="-1"><script language="4"><content>self.x()</content></script>',
            "the script of the box `root` is left out",
        ),
    ],
)
def test_unread_parts_of_a_xar_are_listed(old: str, new: str, message: str) -> None:
    _, found = read("box-library.xar", old, new)
    assert message in [d.message for d in found]


def times(keys: list[dict[str, Any]], joint: str) -> dict[str, float]:
    """Return a joint's angles [deg] by their times."""
    return {key["at"]: key[joint] for key in keys if joint in key}


def test_each_function_that_returns_a_gesture_can_be_chosen() -> None:
    with pytest.raises(ForeignFileError, match=r"`scared`, `happy`.*--timeline"):
        read("library_returns.py")
    assert read("library_returns.py", timeline="happy") == ([{"at": "0.8s", "HeadPitch": -17.1887}], [])
    assert read("library_returns.py", timeline="scared") == ([{"at": "0.8s", "LElbowRoll": -54.7}], [])
    with pytest.raises(ForeignFileError, match="did you mean `happy`"):
        read("library_returns.py", timeline="hapy")


@for_each(
    ("end", "first"),
    [("\nshow()\n", "0.8s"), ("\nif __name__ == '__main__':\n    time.sleep(2)\n    show()\n", "2.8s")],
)
def test_a_function_plays_what_another_returned(end: str, first: str) -> None:
    show = "\ndef show():\n    n, k, t = happy()\n    motion.angleInterpolation(n, k, t, True)\n"
    text = (INPUTS / "library_returns.py.txt").read_text("utf-8") + show + end
    data, found = read_gesture("show.py", text.encode(), BODY)
    assert [frame["at"] for frame in data["keyframes"]] == [first]
    assert [d.message for d in found] == ["the function `scared` is left out: the file does not call it"]


def test_functions_play_in_the_order_of_their_calls() -> None:
    keys, found = read("order.py")
    assert times(keys, "HeadPitch") == {"1s": 17.1887, "2s": 0}
    assert times(keys, "RShoulderPitch") == {"3s": -57.2958, "4s": 80.2141}
    assert found == []


def test_a_function_that_is_called_three_times_plays_three_times() -> None:
    keys, _ = read("order.py", "nod()\nwave()", "nod()\nnod()\nnod()\nwave()")
    nods = {f"{second}s": (17.1887, 0)[second % 2 == 0] for second in range(1, 7)}
    assert times(keys, "HeadPitch") == nods
    assert list(times(keys, "RShoulderPitch")) == ["7s", "8s"]


def test_a_function_that_nothing_calls_is_listed() -> None:
    keys, found = read("order.py", "nod()\nwave()", "wave()")
    assert list(times(keys, "RShoulderPitch")) == ["1s", "2s"]
    assert [(d.message, d.place.line) for d in found] == [
        ("the function `nod` is left out: the file does not call it", 7)
    ]


def test_methods_and_their_arguments_are_followed() -> None:
    robot = """class Robot:
    def __init__(self):
        self.motion = ALProxy("ALMotion", "nao.local", 9559)
    def nod(self, angle, pause=1.0):
        self.motion.angleInterpolation("HeadPitch", angle, 1.0, True)
        time.sleep(pause)
robot = Robot()
robot.nod(0.3)
robot.nod(0.0, pause=2.0)
robot.nod(0.3)
"""
    data, found = read_gesture("robot.py", robot.encode(), BODY)
    keys = [(frame["at"], frame["joints"]["HeadPitch"]) for frame in data["keyframes"]]
    assert keys == [("1s", 17.1887), ("2s", 17.1887), ("3s", 0), ("5s", 0), ("6s", 17.1887)]
    assert found == []


def test_recursion_and_doubling_calls_end() -> None:
    ring = b"def a():\n    motion.angleInterpolation('HeadYaw', 0.1, 1.0)\n    b()\ndef b():\n    a()\na()\n"
    data, found = read_gesture("a.py", ring, BODY)
    assert len(data["keyframes"]) == 1
    assert [d.message for d in found] == ["`a` calls itself: it is imported once"]
    doubling = "".join(f"def f{n}():\n    f{n + 1}()\n    f{n + 1}()\n" for n in range(30))
    last = "def f30():\n    motion.angleInterpolation('HeadYaw', 0.1, 1.0)\nf0()\n"
    with pytest.raises(ForeignFileError, match="more than 20,000 steps"):
        read_gesture("a.py", (doubling + last).encode(), BODY)


def test_a_loop_over_a_long_list_is_followed_only_as_far_as_it_is_short() -> None:
    """Such a loop would take hours: it is read as one whose rounds are not known."""
    call = "motion.angleInterpolation('HeadYaw', 0.1, 1.0)"
    loop = f"for i in range(900):\n    x = [{'0,' * 2_000}]\n    {call}\n"
    data, found = read_gesture("a.py", loop.encode(), BODY)
    assert len(data["keyframes"]) == 1
    assert "this call is in a loop: it is imported once" in [d.message for d in found]
    data, found = read_gesture("a.py", loop.replace("900", "3").encode(), BODY)
    assert len(data["keyframes"]) == 3
    assert found == []


def test_calls_that_are_left_out_are_listed_at_their_places() -> None:
    keys, found = read("other_calls.py")
    assert times(keys, "RShoulderPitch") == {"1s": -57.2958, "2s": 80.2141}
    lost = [(d.place.line, d.message.partition("(")[0].partition(".")[2]) for d in found if d.code == LOST]
    assert lost == [
        (5, "goToPosture"), (6, "setAngles"), (7, "openHand"), (9, "say"), (10, "angleInterpolationWithSpeed"),
        (12, "moveTo"),
    ]  # fmt: skip
    assert all(d.hint for d in found)


@for_each(
    ("statement", "message"),
    [
        ("motion.angleInterpolatoin('HeadYaw', 0.1, 1.0, True)", "`motion.angleInterpolatoin("),
        ("motion.angleInterpolation('HeadYaw', 0.1)", "`angleInterpolation` has 2 arguments"),
        ("qi.async(motion.angleInterpolation, 'HeadYaw')".replace("async", "runAsync"), "`qi.runAsync("),
        ("leds.fadeRGB('FaceLeds', 'red', 1.0)", "`leds.fadeRGB("),
        ("motion.setStiffnesses('Body', 0.0)", "`motion.setStiffnesses("),
        ("if motion.moveTo(1, 0, 0):\n    pass", "`motion.moveTo("),
        ("from moves import bow\nbow()", "`bow()`"),
        ("time.sleep(some)", "the pause `time.sleep(some)` is left out"),
        ("while waiting:\n    time.sleep(0.1)", "this pause is in a loop"),
    ],
)
def test_other_calls_are_listed(statement: str, message: str) -> None:
    _, found = read("sleep.py", "time.sleep(3.0)", statement)
    assert [d.message.startswith(message) for d in found] == [True], found


@for_each(
    ("statement",),
    [
        "print(motion.getAngles('Body', True))",
        "motion.setStiffnesses('Body', 1.0)",
        "sys.exit(1)",
        "session = qi.Session()\nsession.connect('tcp://nao.local')",
    ],
)
def test_calls_that_change_nothing_are_no_findings(statement: str) -> None:
    assert read("sleep.py", "time.sleep(3.0)", statement)[1] == []


def test_pauses_count_and_the_joint_stays_in_them() -> None:
    keys, found = read("sleep.py")
    assert times(keys, "HeadYaw") == {"1s": 34.3775, "4s": 34.3775, "5s": 0}
    assert found == []


@for_each(
    ("call", "wanted"),
    [
        ("['HeadYaw', 'HeadPitch'], [0.4, -0.2], [1.0, 1.5]", [("1s", "HeadYaw"), ("1.5s", "HeadPitch")]),
        ("['HeadYaw', 'HeadPitch'], [0.4, -0.2], 1.0", [("1s", "HeadYaw"), ("1s", "HeadPitch")]),
        ("'Head', [0.4, -0.2], 1.0", [("1s", "HeadYaw"), ("1s", "HeadPitch")]),
        ("'Head', [[0.4], [-0.2]], [[1.0], [1.5]]", [("1s", "HeadYaw"), ("1.5s", "HeadPitch")]),
        ("['Head'], [0.4, -0.2], [1.0, 1.5]", [("1s", "HeadYaw"), ("1.5s", "HeadPitch")]),
        ("['HeadYaw', 'HeadPitch'], [[0.4], -0.2], [1.0, [1.5]]", [("1s", "HeadYaw"), ("1.5s", "HeadPitch")]),
    ],
)
def test_every_form_of_angles_and_times_is_read(call: str, wanted: list[tuple[str, str]]) -> None:
    keys, found = read("spread.py", '["HeadYaw", "HeadPitch"], [0.4, -0.2], [1.0, 1.5]', call)
    assert [(key["at"], joint) for key in keys for joint in key if joint != "at"] == wanted
    angles = {joint: key[joint] for key in keys for joint in key if joint != "at"}
    assert angles == {"HeadYaw": 22.9183, "HeadPitch": -11.4592}
    assert found == []


@for_each(
    ("call",),
    [
        "['HeadYaw', 'HeadPitch'], [0.4], [1.0, 1.5]",
        "['HeadYaw', 'HeadPitch'], [0.4, 0.2], [1.0, 1.5, 2.0]",
        "'Head', [0.4], 1.0",
        "['HeadYaw'], [], []",
    ],
)
def test_angles_and_times_that_do_not_fit_are_a_one_line_error(call: str) -> None:
    with pytest.raises(ForeignFileError, match="do not match"):
        read("spread.py", '["HeadYaw", "HeadPitch"], [0.4, -0.2], [1.0, 1.5]', call)


@for_each(
    ("time", "at"),
    [("00:01:050", "1.05s"), ("00:01:50", "1.05s"), ("1:5", "1.005s"), ("1500", "1.5s"), ("00:75:000", "75s")],
)
def test_milliseconds_of_webots_are_a_number(time: str, at: str) -> None:
    data, found = read_gesture("a.motion", f"#WEBOTS_MOTION,V1.0,HeadYaw\n{time},Pose1,0.1\n".encode(), BODY)
    assert [frame["at"] for frame in data["keyframes"]] == [at]
    assert found == []


def test_the_list_of_a_project_names_its_behaviours(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = (INPUTS / "show.pml").read_text("utf-8")
    more = '<BehaviorDescription name="bow" src="bow" xar="bow.xar" /></BehaviorDescriptions>'
    rows = [
        (text, "import `behavior_1/behavior.xar` instead"),
        (text.replace("</BehaviorDescriptions>", more), "import `behavior_1/behavior.xar` or `bow/bow.xar` instead"),
        ("<Package/>", "the project lists no behaviour"),
    ]
    for content, words in rows:
        (tmp_path / "show.pml").write_text(content, "utf-8")
        assert main(["import", str(tmp_path / "show.pml")]) == 2
        said = capsys.readouterr().err
        assert words in said
        assert "scxml" not in said.lower()
        assert said.count("\n") == 1


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


PODIUM = (
    '<mujoco><worldbody><site name="stage"/><geom type="box" size="{size} 0.01" pos="0 0 -.01"/></worldbody></mujoco>'
)
"""A hall; with the size `.55 .75`, its ground ends 0.55 m ahead and 0.75 m to the side."""


def strays(behavior: str, settings: str = "", size: str = "") -> list[str]:
    """Return place and message of each walk off the ground that lint finds for NAO, in the shipped hall or another."""
    main = "name: Edge\nbehavior: tour\nlanguages: [en]\nrobot: {name: NAO, model: nao}\n"
    files = {"lumen.yaml": f"{main}{settings or 'hall: hall.xml'}\n", "behaviors/tour.yaml": behavior}
    if size:
        box = f'<geom type="box" size="{size} 0.01" pos="0 0 -.01"/>'
        files["models/hall.xml"] = f'<mujoco><worldbody><site name="stage"/>{box}</worldbody></mujoco>'
    found = check_files(Path("edge"), {name: text.encode() for name, text in files.items()})[1]
    return [f"{d.place}: {d.message}" for d in found if d.code == "walk-beyond-ground"]


def test_a_walk_over_the_edge_is_found_without_a_stage() -> None:
    text = (INPUTS / "walk-over-the-edge.yaml").read_text("utf-8")
    where = "behaviors/tour.yaml:5:29: this walk leads off the ground, to x 0.56 m, y 0.00 m from the start"
    assert strays(text) == [where]
    assert strays(text.replace("x: 0.8", "x: 0.5")) == []
    assert strays(text, "hall: hall.xml\nstage: {x: [-0.4, 0.4], y: [-0.6, 0.6]}") == [], "a stage keeps the feet on it"
    assert strays(text, "units: {length: m}") == [], "without a hall the ground is unknown"
    assert strays(text, size="1 1") == [], "this hall's ground is larger"
    assert strays(text.replace("x: 0.8", "x: 1.2"), size="1 1") == [where.replace("0.56", "1.02")]


def doing(*steps: str) -> str:
    """Return a behaviour with one state for each step."""
    states = "".join(f"  s{i}: {{do: {step}, onDone: s{i + 1}, onError: end}}\n" for i, step in enumerate(steps))
    ends = f"  s{len(steps)}: {{}}\n  end: {{}}\non: {{fallen: .end}}\n"
    return f"units: {{angle: deg}}\ninitial: s0\nstates:\n{states}{ends}"


FORTH, BACK, TURN, ASIDE = "{walk: {x: 0.3}}", "{walk: {x: -0.3}}", "{walk: {theta: 90}}", "{walk: {x: 0.3, y: -0.1}}"
IF = "{if: 'event.name == null', then: {walk: {x: 0.4}}, else: {walk: {x: 0.1}}}"
ENTRY = "initial: a\nstates:\n  a: {entry: {walk: {x: 0.6}}, after: {9s: b}}\n  b: {do: {walk: {x: 0.6}}}\n"
ACTIONS = "initial: a\nstates:\n  a: {on: {touched: {target: b, actions: {walk: {x: 0.6}}}}}\n  b: {}\n"


@for_each(
    ("behavior", "lines"),
    [
        (doing(FORTH, FORTH), ["5 0.56 0.00"]),
        (doing(f"[{FORTH}, {FORTH}]"), ["4 0.56 0.00"]),
        (doing(FORTH, BACK, FORTH), []),
        (doing(TURN, FORTH, FORTH, FORTH), ["7 0.00 0.76"]),
        (doing(TURN, TURN, FORTH, BACK, BACK, BACK), ["9 0.56 0.00"]),
        (doing(TURN, ASIDE, ASIDE), []),
        (doing(TURN, ASIDE, ASIDE, TURN, FORTH, FORTH, FORTH), ["10 -0.56 0.60"]),
        (doing("{parallel: [{wait: 1s}, {walk: {x: 0.6}}]}"), ["4 0.56 0.00"]),
        (doing(FORTH, IF, FORTH), ["5 0.56 0.00"]),
        (doing(FORTH, "{walk: {vx: 0.1}}", FORTH), []),
        (doing(FORTH).replace("  s1: {}", "  s1: {after: {1s: s0}}"), []),
        (doing(FORTH, "{say: Hello}", FORTH).replace("onDone: s1,", "onDone: s1, after: {1s: s1},"), ["6 0.56 0.00"]),
        (doing(FORTH, FORTH).replace("onDone: s1", "on: {touched: s1}"), []),
        (ENTRY, ["3 0.56 0.00"]),
        (ACTIONS, ["3 0.56 0.00"]),
        ("type: parallel\nstates:\n  a: {do: {walk: {x: 0.4}}}\n  b: {do: {walk: {x: 0.6}}}\n", []),
        ("type: parallel\nstates:\n  a: {do: {say: Hello}}\n  b: {do: {walk: {x: 0.6}}}\n", ["4 0.56 0.00"]),
    ],
)
def test_walks_add_up_on_each_way(behavior: str, lines: list[str]) -> None:
    found = [message.replace(",", "").split() for message in strays(behavior)]
    assert [f"{words[0].split(':')[1]} {words[9]} {words[12]}" for words in found] == lines


def test_a_place_without_ground_is_found_without_a_stage() -> None:
    places = "hall: hall.xml\nplaces: {near: {x: 0.5, y: 0, heading: 180}, far: {x: 0.8, y: 0}}"
    behavior = doing("{walk: {to: near}}", "{walk: {x: -0.1}}", "{walk: {to: far}}")
    assert strays(behavior, places) == [
        "behaviors/tour.yaml:5:13: this walk leads off the ground, to x 0.56 m, y 0.00 m from the start",
        "lumen.yaml:6:46: there is no ground at `far` in hall.xml: the robot would fall",
    ]


class OwnRobot:
    """A user's own robot without checks: it records each command and finishes it at once."""

    def __init__(self) -> None:
        self.given: list[RobotCommand] = []
        self.answers: list[Event] = []

    def start(self, id: str, command: RobotCommand) -> None:
        self.given.append(command)
        self.answers.append(Event(f"done.command.{id}", None, 0.0))

    def cancel(self, id: str) -> None:
        pass

    def poll(self) -> list[Event]:
        answers, self.answers = self.answers, []
        return answers

    def begun(self) -> list[str]:
        return []

    def read(self, sense: Sense) -> None:
        pass

    def close(self) -> None:
        pass


def limited(name: str) -> tuple[float, float]:
    return BODY.joints[name].minimum, BODY.joints[name].maximum


def test_a_users_own_robot_never_looks_beyond_its_limits(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    (tmp_path / "behaviors").mkdir()
    (tmp_path / "lumen.yaml").write_text("name: Own\nbehavior: tour\nlanguages: [en]\nrobot: {name: NAO, model: nao}\n")
    (tmp_path / "behaviors/tour.yaml").write_text(
        "units: {angle: deg}\ninitial: a\nstates:\n"
        "  a: {do: [{look: {yaw: 121, pitch: 60}}, {look: {yaw: 30, pitch: 10}}, {look: {yaw: 121, pitch: 60}}]}\n"
    )
    robot = OwnRobot()
    with lumen.open(tmp_path, robot=robot, clock=VirtualClock()) as exhibition:
        exhibition.run(seconds=2)
    first, middle, last = [command for command in robot.given if isinstance(command, Look)]
    assert first.yaw == limited("HeadYaw")[1]
    assert limited("HeadPitch")[0] <= first.pitch < radians(30), "where the head is turned, it can't nod as far"
    assert middle == Look(radians(30), radians(10))
    assert last == first
    assert [r.message for r in caplog.records if "look" in r.message] == [
        "`look` turns `HeadYaw` to 119.5 deg, not to 121.0 deg, which is beyond its limit",
        f"`look` turns `HeadPitch` to {degrees(first.pitch):.1f} deg, not to 60.0 deg, which is beyond its limit",
    ]


def key(at: float, angle: float, **handles: Any) -> Keyframe:
    return Keyframe(at, angle, Interpolation.BEZIER if handles else Interpolation.MINIMUM_JERK, **handles)


@for_each(
    "tracks",
    [
        {"HeadYaw": (key(1.0, 2.2), key(2.0, 0.0))},
        {"HeadYaw": (key(1.0, 0.0), key(1.01, 1.0), key(2.0, 0.0)), "HeadPitch": (key(1.01, 0.1), key(2.0, 0.2))},
        {"HeadYaw": (key(1.0, 2.0, handle_out=(0.3, 2.0)), key(2.0, 2.0, handle_in=(-0.3, 2.0)))},
        {"HeadYaw": (key(1.0, 2.0),), "HeadPitch": (key(1.5, 0.5),)},
        {"LHand": (key(1.0, 1.4), key(2.0, -3.0))},
    ],
)
def test_a_motion_is_brought_within_the_limits_and_speeds(tracks: dict[str, tuple[Keyframe, ...]]) -> None:
    motion = MotionDefinition("nod", 2.5, tracks, (Cue(1.01, "say", "now"),))
    assert beyond_limits(motion, BODY) or overspeed(motion, BODY)
    command, changes = within_limits(Perform(motion), BODY)
    assert isinstance(command, Perform)
    assert not beyond_limits(command.motion, BODY)
    assert not overspeed(command.motion, BODY)
    assert changes
    keys = command.motion.tracks
    assert [len(keys[joint]) >= len(tracks[joint]) for joint in tracks] == [True] * len(tracks)
    assert command.motion.duration >= motion.duration
    assert all(each[-1].time <= command.motion.duration for each in keys.values())


def test_a_slowed_motion_stays_in_step_with_its_words() -> None:
    tracks = {"HeadYaw": (key(1.0, 0.0), key(1.01, 1.0), key(2.0, 0.0)), "HeadPitch": (key(1.01, 0.1), key(2.0, 0.2))}
    command, changes = within_limits(Perform(MotionDefinition("nod", 2.5, tracks, (Cue(1.01, "say", "now"),))), BODY)
    assert isinstance(command, Perform)
    yaw, pitch, cue = command.motion.tracks["HeadYaw"], command.motion.tracks["HeadPitch"], command.motion.cues[0]
    assert yaw[0].time == 1.0
    assert yaw[1].time == pitch[0].time == cue.time > 1.1
    assert yaw[2].time - yaw[1].time == pytest.approx(0.99)
    assert command.motion.duration - yaw[2].time == pytest.approx(0.5)
    assert changes == ("`nod` takes longer: `HeadYaw` needs more time to reach its key at 1.01 s",)


def test_a_command_within_the_limits_is_unchanged() -> None:
    tracks = {"HeadYaw": (key(1.0, 1.0), key(2.0, 0.0))}
    for command in (Look(0.3, 0.1), Perform(MotionDefinition("nod", 2.5, tracks)), Aim({"HeadYaw": 1.0}, 0.5), Wake()):
        assert within_limits(command, BODY) == (command, ())
        assert within_limits(command, BODY).command is command
    assert within_limits(Aim({"HeadYaw": 9.0, "nose": 9.0}, 3.0), BODY).command == Aim(
        {"HeadYaw": limited("HeadYaw")[1], "nose": 9.0}, 1.0
    )


def test_a_motion_is_analysed_once_for_each_body(monkeypatch: pytest.MonkeyPatch) -> None:
    calls: list[tuple[str, Body]] = []
    analysed = bounds._analysed

    def counted(motion: MotionDefinition, body: Body) -> tuple[MotionDefinition, tuple[str, ...], bool]:
        calls.append((motion.name, body))
        return analysed(motion, body)

    monkeypatch.setattr(bounds, "_analysed", counted)
    near = MotionDefinition("near", 2.5, {"HeadYaw": (key(1.0, 1.0), key(2.0, 0.0))})
    far = MotionDefinition("far", 2.5, {"HeadYaw": (key(1.0, 9.0), key(2.0, 0.0))})
    bounds.analyse([near, far], BODY)
    assert [name for name, _ in calls] == ["near", "far"]
    first, second = (within_limits(Perform(far), BODY) for _ in range(2))
    assert first == second
    assert first.changes
    assert within_limits(Perform(near), BODY) == (Perform(near), ())
    assert len(calls) == 2
    within_limits(Perform(replace(far)), BODY)
    other = replace(BODY, name="another")
    assert within_limits(Perform(far), other) == first
    assert calls[2:] == [("far", BODY), ("far", other)]
    number = len(bounds._analyses)
    del near, far, first, second
    gc.collect()
    assert len(bounds._analyses) <= number - 2, "an analysis ends with its motion"


def script(*lines: str, timeline: str = "") -> tuple[list[dict[str, Any]], list[Diagnostic]]:
    """Read a script for NAOqi; return the keyframes and the findings."""
    text = "\n".join(("motion = ALProxy('ALMotion')", "nod = [0.2, 0.0]", *lines))
    data, found = read_gesture("loop.py", text.encode(), BODY, timeline=timeline)
    return [{"at": frame["at"], **frame["joints"]} for frame in data["keyframes"]], found


NOD = "    motion.angleInterpolation('HeadPitch', nod, [0.5, 1.0], True)"
TWICE = [{"at": f"{at}s", "HeadPitch": angle} for at, angle in (("0.5", 11.4592), ("1", 0), ("1.5", 11.4592), ("2", 0))]


@for_each(
    "lines",
    [
        ("for i in range(2):", NOD),
        ("for i in range(4, 0, -2):", NOD),
        ("for name in ('HeadPitch', 'HeadPitch'):", NOD.replace("'HeadPitch'", "name")),
        ("for i in range(len(nod)):", NOD),
        ("def f():", NOD, "for i in [1]:", "    for j in range(2):", "        f()"),
        ("for name, angles in [('HeadPitch', nod), ('HeadPitch', nod)]:", NOD.replace("nod", "angles")),
        ("for at in nod:", "    pass", "for i in range(2):", NOD, "else:", "    pass"),
    ],
)
def test_a_loop_over_literal_values_repeats(lines: tuple[str, ...]) -> None:
    assert script(*lines) == (TWICE, [])


@for_each(
    "head",
    [
        "while True:",
        "for i in range(count):",
        "for i in range(100000):",
        "for i in range(10 ** 30):",
        "for i in range(1, 9, 0):",
        "for i in range(2):\n    if touched(): break",
        "for name, angle in zip(names, angles):",
    ],
)
def test_a_loop_that_may_end_at_any_time_is_listed(head: str) -> None:
    keys, found = script("count = motion.getCount()", head, NOD)
    assert keys == TWICE[:2]
    assert "this call is in a loop: it is imported once" in {d.message for d in found}


def test_nested_loops_end_in_time() -> None:
    loops = [f"{'    ' * i}for i{i} in range(900):" for i in range(6)]
    assert any("in a loop" in d.message for d in script(*loops, " " * 20 + NOD)[1])


def test_the_type_of_each_handle_counts() -> None:
    keys = "[0.1, [3, -0.1, 0], [3, 0.1, 0]], [0.2, [3, -0.1, 0], [3, 0.1, 0]]"
    call = "motion.angleInterpolationBezier(['HeadYaw'], [[1.0, 2.0]], [[KEYS]])"
    plain = script(call.replace("KEYS", keys))
    assert plain[1] == []
    for old, new in (("[3, 0.1, 0]], [0.2", "[1, 0.1, 0]], [0.2"), ("[0.2, [3", "[0.2, [2"), ("[0.2, [3", "[0.2, [1")):
        assert old in keys
        found = script(call.replace("KEYS", keys.replace(old, new)))[1]
        assert [d.message for d in found] == ["`HeadYaw` reaches its key at 2 s with an unknown interpolation"], new


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


def test_a_script_with_odd_numbers_and_escapes_shows_no_python_warning(recwarn: pytest.WarningsRecorder) -> None:
    assert script("shown = '\\d' if 1in nod else 0", "if True:", NOD)[0] == TWICE[:2]
    assert not recwarn.list
