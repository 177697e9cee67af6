"""Imports of motions of Webots, Choregraphe and NAOqi's Python, and of files that are not motions."""

from math import degrees, radians
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

import lumen
from lumen.cli.main import main
from lumen.language.diagnostics import Diagnostic
from lumen.language.motions import MotionDefinition
from lumen.motion.trajectories import Trajectory
from lumen.project.document_report import DocumentReport
from lumen.project.formats.conversion_findings import ForeignFileError
from lumen.project.formats.importers import read_gesture
from lumen.project.formats.yaml_document import document_yaml
from lumen.project.motions import build_motion
from lumen.project.packaged import shipped_root
from lumen.project.schema import check_schema
from lumen.project.yaml_reader import parse
from tests.tables import for_each

BODY = lumen.load(shipped_root()).body

WEBOTS = """#WEBOTS_MOTION,V1.0,RShoulderPitch,HeadYaw
00:00:500,Pose1,-1.0,0.2
00:01:000,Pose2,*,-0.2
00:02:500,Pose3,0.5,*
"""

XAR = """<?xml version="1.0" encoding="UTF-8" ?>
<ChoregrapheProject xmlns="http://www.aldebaran-robotics.com/schema/choregraphe/project.xsd" xar_version="3">
<Box name="root" id="-1"><Timeline enable="0"><BehaviorLayer name="l"><BehaviorKeyframe name="k" index="1"><Diagram>
{boxes}
</Diagram></BehaviorKeyframe></BehaviorLayer></Timeline></Box></ChoregrapheProject>
"""
WAVE = """<Box name="{name}" id="1"><Timeline enable="1" fps="20" start_frame="1" end_frame="-1" size="40">
<ActuatorList model="nao">
<ActuatorCurve name="value" actuator="HeadYaw" mute="0" unit="0"><Key frame="20" value="10">
<Tangent side="left" interpType="bezier" abscissaParam="-5" ordinateParam="1.5" />
<Tangent side="right" interpType="bezier" abscissaParam="4" ordinateParam="-1.5" /></Key><Key frame="40" value="-10" />
</ActuatorCurve>
<ActuatorCurve name="value" actuator="RHand" mute="0" unit="1"><Key frame="20" value="0.75" /></ActuatorCurve>
</ActuatorList></Timeline></Box>"""

EXPORT = """# Choregraphe bezier export in Python.
from naoqi import ALProxy
names = list()
times = list()
keys = list()

names.append("HeadYaw")
times.append([1, 2])
keys.append([[0.5, [3, -0.25, 0], [3, 0.2, 0.1]], [-0.5, [3, -0.3, 0], [3, 0, 0]]])

names.append("LHand")
times.append([1.5])
keys.append([[0.3, [3, -0.5, 0], [3, 0, 0]]])

try:
  motion = ALProxy("ALMotion")
  motion.angleInterpolationBezier(names, times, keys)
except BaseException, err:
  print err
"""


def read(file: str, text: str, timeline: str = "") -> tuple[dict[str, Any], list[Diagnostic]]:
    return read_gesture(file, text.encode(), BODY, timeline=timeline)


def built(data: dict[str, Any]) -> MotionDefinition:
    """Return the motion of a file with that data; fail if the file has a fault."""
    document, found = parse("motion.yaml", document_yaml(data, "motion").encode())
    assert document is not None
    report = DocumentReport(document)
    motion = build_motion(check_schema(document, "motion", report), report, name="motion", body=BODY)
    assert [*found, *report.diagnostics] == []
    assert motion is not None
    return motion


def said(diagnostics: list[Diagnostic]) -> list[str]:
    return [f"{d.place.line}:{d.place.column} {d.code} {d.message}" for d in diagnostics]


def test_webots_is_joined_by_lines() -> None:
    data, diagnostics = read("wave.motion", WEBOTS)
    assert diagnostics == []
    curve = Trajectory(built(data), {"RShoulderPitch": 0.0, "HeadYaw": 0.0})
    assert curve.sample(1.5)["RShoulderPitch"] == pytest.approx(-0.25, abs=1e-5)
    assert curve.sample(0.75)["HeadYaw"] == pytest.approx(0.0, abs=1e-5)
    assert built(data).duration == 2.5


def test_names_in_the_second_line_and_windows_endings() -> None:
    data, diagnostics = read("wave.motion", WEBOTS.replace("V1.0,", "V1.0\r\n").replace("\n", "\r\n"))
    assert diagnostics == []
    assert data["keyframes"] == read("wave.motion", WEBOTS)[0]["keyframes"]


def test_a_pose_at_nought_is_come_to_in_a_second() -> None:
    data, diagnostics = read("wave.motion", WEBOTS.replace("00:00:500", "00:00:000"))
    assert [frame["at"] for frame in data["keyframes"]] == ["1s", "2s", "3.5s"]
    assert [d.code for d in diagnostics] == ["carried-over-differently"]


def test_what_the_robot_cannot_do_is_said_where_it_stands() -> None:
    text = "#WEBOTS_MOTION,V1.0,HipRoll,HeadYaw\n00:01:000,Bow,0,9\n00:00:500,Pose2,0,x\nrubbish\n00:02:000,Pose3,0\n"
    data, diagnostics = read("bow.motion", text)
    assert data["keyframes"] == [{"at": "1s", "joints": {"HeadYaw": 119.5001}}]
    assert said(diagnostics) == [
        "2:11 carried-over-differently the names of poses are left out: keyframes in Lumen have no names",
        "2:15 not-carried-over NAO has no joint `HipRoll`",
        "2:17 carried-over-differently `HeadYaw` can't reach 515.662 deg: it goes to 119.5 deg",
        "3:19 not-carried-over `x` is not an angle",
        "4:1 not-carried-over this line can't be read: write a time such as 00:01:500",
        "5:1 not-carried-over this line can't be read: write a name and 2 angles",
    ]


def test_times_that_go_back_are_left_out() -> None:
    data, diagnostics = read("wave.motion", WEBOTS.replace("00:02:500,Pose3,0.5,*", "00:00:700,Pose3,0.5,0.1"))
    assert [frame["at"] for frame in data["keyframes"]] == ["0.5s", "0.7s", "1s"]
    assert said(diagnostics) == [
        "4:21 not-carried-over the key of `HeadYaw` at 0.7 s is left out: the key before it is at 1 s"
    ]


def test_a_time_before_the_beginning_is_left_out() -> None:
    data, said = read("a.py", "motion.angleInterpolation('HeadYaw', [0.1, 0.2], [-1.0, 1.0], True)\n")
    assert [frame["at"] for frame in data["keyframes"]] == ["1s"]
    assert [d.message for d in said] == ["`HeadYaw` has a key 1 s before the motion begins"]


def test_a_timeline_without_frames_a_second_has_the_usual_ones() -> None:
    data, said = read("a.xar", XAR.format(boxes=WAVE.format(name="W").replace('fps="20"', 'fps="0"')))
    assert [frame["at"] for frame in data["keyframes"]] == ["0.8s", "1.6s"]
    assert "it is read with 25 frames per second" in said[0].message


def test_choregraphe_keeps_its_tangents() -> None:
    data, diagnostics = read("wave.xar", XAR.format(boxes=WAVE.format(name="Wave")))
    assert diagnostics == []
    motion = built(data)
    first, last = motion.tracks["HeadYaw"]
    assert (first.time, last.time) == (1.0, 2.0)
    assert first.handle_in == pytest.approx((-0.25, radians(1.5)))
    assert first.handle_out == pytest.approx((0.2, radians(-1.5)))
    assert motion.tracks["RHand"][0].angle == 0.75


def test_one_of_several_timelines() -> None:
    boxes = WAVE.format(name="Wave") + WAVE.format(name="Wave").replace('"10"', '"20"') + WAVE.format(name="Bow")
    text = XAR.format(boxes=boxes)
    with pytest.raises(ForeignFileError, match="several timelines: `Wave`, `Wave 2`, `Bow`"):
        read("wave.xar", text)
    with pytest.raises(ForeignFileError, match="did you mean `Bow`"):
        read("wave.xar", text, "Bowe")
    data, diagnostics = read("wave.xar", text, "Wave 2")
    assert data["keyframes"][0]["joints"]["HeadYaw"] == 20
    assert [d.message.split(" is left out")[0] for d in diagnostics] == ["the box `Wave`", "the box `Bow`"]


def test_muted_curves_and_other_boxes_are_listed() -> None:
    boxes = WAVE.format(name="Wave").replace('mute="0"', 'mute="1"', 1) + '<Box name="Say" id="2"></Box>'
    data, diagnostics = read("wave.xar", XAR.format(boxes=boxes))
    assert data["keyframes"] == [{"at": "1s", "joints": {"RHand": 0.75}}]
    assert [d.message for d in diagnostics] == [
        "`HeadYaw` is muted",
        "the box `Say` is left out: only the joints of a timeline are imported",
    ]


def test_straight_ways_among_curves_stay_straight() -> None:
    straight = '<Key frame="40" value="-10"><Tangent side="left" interpType="linear" abscissaParam="0" /></Key>'
    wave = WAVE.format(name="Wave").replace('<Key frame="40" value="-10" />', straight)
    curve = Trajectory(built(read("wave.xar", XAR.format(boxes=wave))[0]), {"HeadYaw": 0.0, "RHand": 0.0})
    assert degrees(curve.sample(1.25)["HeadYaw"]) == pytest.approx(5.0, abs=1e-3)


def test_an_export_in_python_is_read_and_not_run() -> None:
    data, diagnostics = read("keys.py", EXPORT)
    assert diagnostics == []
    motion = built(data)
    first, last = motion.tracks["HeadYaw"]
    assert first.angle == pytest.approx(0.5, abs=1e-5)
    assert first.handle_out == pytest.approx((0.2, 0.1), abs=1e-5)
    assert last.handle_in == pytest.approx((-0.3, 0.0))
    assert motion.tracks["LHand"][0].handle_in == (-0.5, 0.0)


def test_calls_come_one_after_another() -> None:
    calls = """
motion.angleInterpolation("HeadYaw", [30.0*almath.TO_RAD, 0.0], [1.0, 2.0], True)
motion.angleInterpolation(["HeadYaw", "HeadPitch"], [[-math.radians(30)], [0.1]], [[1.0], [0.5]], True)
motion.angleInterpolation("HeadYaw", 0.1, 1.0, False)
"""
    data, diagnostics = read("keys.py", calls)
    assert data["keyframes"] == [
        {"at": "1s", "joints": {"HeadYaw": 30}},
        {"at": "2s", "joints": {"HeadYaw": 0}},
        {"at": "2.5s", "joints": {"HeadPitch": 5.7296}},
        {"at": "3s", "joints": {"HeadYaw": -30}},
    ]
    assert said(diagnostics) == ["4:1 not-carried-over relative angles can't be imported"]


def test_what_only_a_run_would_tell_is_listed() -> None:
    data, diagnostics = read("keys.py", EXPORT.replace("[[0.3, [3, -0.5, 0], [3, 0, 0]]]", "[compute()]"))
    assert "LHand" not in str(data["keyframes"])
    assert said(diagnostics)[-1] == "13:14 not-carried-over `compute()` is known only when the file runs"


def test_of_what_only_a_run_would_tell_sixty_characters_are_shown() -> None:
    long = f"compute({'a' * 100})"
    _, diagnostics = read("keys.py", EXPORT.replace("[[0.3, [3, -0.5, 0], [3, 0, 0]]]", f"[{long}]"))
    assert said(diagnostics)[-1] == f"13:14 not-carried-over `{long[:60]}` is known only when the file runs"


@for_each(
    ("file", "text", "message"),
    [
        ("a.motion", "", "does not begin with"),
        ("a.motion", "#WEBOTS_MOTION,V2.0,HeadYaw\n", "only V1.0 and V1.1 can be read"),
        ("a.motion", "#WEBOTS_MOTION,V1.0,HeadYaw,HeadYaw\n", "listed twice"),
        ("a.motion", "#WEBOTS_MOTION,V1.1,HeadYaw%HeadYaw\n", "the joint `HeadYaw` is listed twice"),
        ("a.motion", "#WEBOTS_MOTION,V1.0,HeadYaw\n", "the file moves no joint of NAO"),
        ("a.motion", "#WEBOTS_MOTION,V1.0\n00:00:100,a,1\n", "contains no joint names"),
        (
            "a.motion",
            "#WEBOTS_MOTION,V1.0,HeadYaw\n00:00:100,a,nan\n",
            "the file moves no joint .*: `nan` is not an angle",
        ),
        ("a.xar", "<a/>", "not a Choregraphe behaviour"),
        ("a.xar", "hello", "not XML"),
        ("a.xar", XAR.format(boxes=""), "no timeline in the file moves a joint"),
        ("a.py", "def f(:\n", "not Python"),
        ("a.py", "import os\nos.system('true')\n", "no keyframes"),
        ("a.py", "[" * 5000, "not Python"),
        ("a.py", "x = 1\0", "not Python"),
        ("a.py", "motion.angleInterpolation('HeadYaw', 1e400, 1.0)", "the file moves no joint"),
    ],
)
def test_files_that_are_none(file: str, text: str, message: str) -> None:
    with pytest.raises(ForeignFileError, match=message):
        read(file, text)


@given(ending=st.sampled_from([".motion", ".xar", ".py"]), place=st.integers(0, 900), junk=st.binary(max_size=6))
def test_no_file_is_a_traceback(ending: str, place: int, junk: bytes) -> None:
    whole = {".motion": WEBOTS, ".xar": XAR.format(boxes=WAVE.format(name="W")), ".py": EXPORT}[ending].encode()
    try:
        data, _ = read_gesture(f"a{ending}", whole[:place] + junk + whole[place + len(junk) :], BODY)
    except ForeignFileError:
        return
    assert data["keyframes"]


@pytest.mark.slow
def test_the_commands(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file, out = tmp_path / "wave.motion", tmp_path / "wave.yaml"
    file.write_text(WEBOTS)
    assert main(["import", str(file), "-o", str(out)]) == 0
    assert out.read_text().startswith("# yaml-language-server: $schema=../schemas/motion.schema.json\n")
    assert main(["play", str(file)]) == 1
    played = capsys.readouterr()
    assert "NAO plays `wave` (2.5 s)" in played.out
    assert "in `wave` a joint missed its goal: `RShoulderPitch` was 0." in played.err  # half a second is too short
    file.write_text("#WEBOTS_MOTION,V1.0,HeadYaw\n00:00:100,Pose,2.0\n00:00:300,Pose,-2.0\n")
    assert main(["play", str(file)]) == 1
    told = capsys.readouterr().err
    assert "`HeadYaw` comes late: to get there by 0.30 s it would have to move at 20 rad/s" in told
    assert "in `wave` a joint missed its goal: `HeadYaw` was" in told
    file.write_text("nothing")
    assert main(["play", str(file)]) == 2
    assert "does not begin with" in capsys.readouterr().err
    assert main(["play", str(file.rename(tmp_path / "wave.json"))]) == 2
    assert "wave.json is not a motion: its name must end in .yaml, .motion, .xar or .py" in capsys.readouterr().err
