"""Imported motions that exceed the robot's abilities: what is cut, what gets more time, and what is reported."""

from pathlib import Path
from shutil import copytree

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lumen.cli.main import main
from lumen.motion.limits import beyond_limits, overspeed
from lumen.project.formats.conversion_findings import ForeignFileError
from lumen.project.formats.importers import read_gesture
from lumen.project.packaged import shipped_root
from tests.features.formats_motion.test_gestures import BODY, EXPORT, WAVE, XAR, built, read, said
from tests.tables import for_each

SOCCER = """#WEBOTS_MOTION,V1.1
HeadYaw%HeadPitch
play%0.500%+0.100%0.500
play%-0.500%-0.100%1.500
"""
ANKLE = "#WEBOTS_MOTION,V1.0,LAnklePitch,LAnkleRoll\n00:01:000,Pose1,{pitch},{roll}\n"


def test_soccer_teams_write_what_a_pose_takes() -> None:
    data, diagnostics = read("fall.motion", SOCCER)
    assert diagnostics == []
    assert [frame["at"] for frame in data["keyframes"]] == ["0.5s", "2s"]
    assert built(data).tracks["HeadYaw"][1].angle == pytest.approx(-0.5, abs=1e-5)
    one_line = SOCCER.replace("V1.1\n", "V1.1,")
    assert read("fall.motion", one_line)[0]["keyframes"] == data["keyframes"]


def test_lines_of_soccer_teams_that_are_no_pose_are_listed() -> None:
    text = SOCCER.replace("play%-0.5", "wait%-0.5") + "play%x%0%1\nplay%0%0%0\nplay%0%0\n"
    data, diagnostics = read("fall.motion", text)
    assert [frame["at"] for frame in data["keyframes"]] == ["0.5s", "1.5s"]
    unread = "this line can't be read: write `play%`, 2 angles and a time above 0 s, separated by `%`"
    assert said(diagnostics) == [
        f"4:1 not-carried-over {unread}",
        "5:6 not-carried-over `x` is not an angle",
        f"6:1 not-carried-over {unread}",
        f"7:1 not-carried-over {unread}",
    ]


def test_an_ankle_goes_as_far_as_its_other_angle_lets_it() -> None:
    data, diagnostics = read("ankle.motion", ANKLE.format(pitch=0.9, roll=0.3))
    motion = built(data)
    assert beyond_limits(motion, BODY) == []
    assert motion.tracks["LAnkleRoll"][0].angle < 0.1
    assert said(diagnostics) == [
        "2:21 carried-over-differently `LAnkleRoll` can't reach 17.19 deg"
        " at the angle that `LAnklePitch` has at that time: "
        f"it goes to {round(data['keyframes'][0]['joints']['LAnkleRoll'], 2):g} deg"
    ]


def test_an_ankle_gets_a_key_where_only_its_other_angle_has_one() -> None:
    text = ANKLE.format(pitch=0, roll=0.3) + "00:02:000,Pose2,0.9,*\n"
    data, diagnostics = read("ankle.motion", text)
    assert beyond_limits(built(data), BODY) == []
    assert [sorted(frame["joints"]) for frame in data["keyframes"]] == [["LAnklePitch", "LAnkleRoll"]] * 2
    assert "at the angle that `LAnklePitch` has at 2 s" in diagnostics[0].message


def test_handles_that_carry_a_joint_too_far_are_left_out() -> None:
    curve = "motion.angleInterpolationBezier(['HeadPitch'], [[1.0, 2.0]], [[[0.5, [3, -0.1, 0], [3, 0.3, 0.6]], [0.5, [3, -0.3, 0.6], [3, 0, 0]]]])\n"  # noqa: E501
    data, diagnostics = read("a.py", curve)
    assert beyond_limits(built(data), BODY) == []
    assert [d.message.split(":")[1] for d in diagnostics] == [" its handles are left out"]


def test_what_is_too_fast_gets_time_for_all_joints_together() -> None:
    text = "#WEBOTS_MOTION,V1.0,HeadYaw,HeadPitch\n00:01:000,Pose1,-1,0\n00:01:100,Pose2,1,0.1\n00:02:100,Pose3,1,0\n"
    hasty = built(read("a.motion", text)[0])
    assert [excess.joint for excess in overspeed(hasty, BODY)] == ["HeadYaw"]
    data, findings = read_gesture("a.motion", text.encode(), BODY, retime=True)
    motion = built(data)
    assert overspeed(motion, BODY) == []
    times = [[key.time for key in track] for track in motion.tracks.values()]
    assert times[0] == times[1]
    assert times[0][0] == 1.0
    assert times[0][2] - times[0][1] == pytest.approx(1.0, abs=1e-3), "what was slow enough takes as long as before"
    assert [d.message.partition(":")[0] for d in findings] == ["`HeadYaw` would be too fast"]


ANGLES = st.floats(-3.2, 3.2, allow_nan=False)
GAPS = st.lists(st.tuples(st.floats(0.01, 2.0), *[ANGLES] * 4, st.booleans()), min_size=1, max_size=8)


@given(rows=GAPS, curved=st.booleans())
def test_whatever_somebody_wrote_is_within_limits_and_speeds(rows: list[tuple[float, ...]], curved: bool) -> None:
    joints = ["LAnklePitch", "LAnkleRoll", "HeadYaw", "RShoulderRoll"]
    time, times, keys = 0.5, [], [[] for _ in joints]  # type: ignore[var-annotated]
    for gap, *angles, _ in rows:
        time += gap
        times.append(time)
        for track, angle in zip(keys, angles, strict=True):
            track.append([angle, [3, -gap / 2, angle / 3], [3, gap / 2, -angle]] if curved else [angle])
    call = f"motion.angleInterpolationBezier({joints}, {[times] * len(joints)}, {keys})"
    data, _ = read_gesture("a.py", call.encode(), BODY, retime=True)
    motion = built(data)
    assert beyond_limits(motion, BODY) == []
    assert overspeed(motion, BODY) == []


@for_each(
    ("statement", "message"),
    [
        ("for i in range(2):\n    times[i][0] = times[i][0] * 2", "`times[i][0] = times[i][0] * 2` changes `times`"),
        ("for row in range(2):\n    times[row].append(9.0)", "`times[row].append(9.0)` changes `times`"),
        ("while names: names.append('HeadPitch')", "`names.append('HeadPitch')` changes `names`"),
        ("times[0][0] *= 3", "`times[0][0] *= 3` changes `times`"),
        ("keys[0].reverse()", "`keys[0].reverse()` changes `keys`"),
        ("del times[0][1]", "`del times[0][1]` changes `times`"),
        ("def slow(t):\n    t.reverse()\nslow(times)", "`slow(times)` changes `times`"),
        ("if names:\n    pass\nelse:\n    times = [[9.0]]", "`times = [[9.0]]` changes `times`"),
    ],
)
def test_what_a_program_changes_before_the_call_is_said(statement: str, message: str) -> None:
    before, call, after = EXPORT.partition("try:")
    data, diagnostics = read("keys.py", f"{before}{statement}\n\n{call}{after}")
    assert data["keyframes"] == read("keys.py", EXPORT)[0]["keyframes"]
    assert [d.code for d in diagnostics] == ["not-carried-over"]
    assert diagnostics[0].message.startswith(message)
    assert f"{before}{statement}".splitlines()[diagnostics[0].place.line - 1].strip().endswith(message.split("`")[1])


def test_a_list_whose_length_a_loop_changes_is_refused() -> None:
    before, call, after = EXPORT.partition("try:")
    with pytest.raises(ForeignFileError, match="the names, times and keys of this call do not match"):
        read("keys.py", f"{before}for i in range(3): names.append('HeadPitch')\n\n{call}{after}")


def test_what_changes_other_variables_is_not_said() -> None:
    before, call, after = EXPORT.partition("try:")
    more = "count = 0\nfor i in range(3):\n    count += 1\n    print(count)\n\n"
    assert read("keys.py", before + more + call + after)[1] == []


def test_a_call_in_a_loop_or_a_question_is_said() -> None:
    call = "motion.angleInterpolation('HeadYaw', [0.1], [1.0], True)"
    _, looped = read("a.py", f"while True:\n    {call}\n")
    assert said(looped) == ["2:5 not-carried-over this call is in a loop: it is imported once"]
    _, asked = read("a.py", f"if x:\n    {call}\n")
    assert said(asked) == ["2:5 carried-over-differently this call is in an `if`: it is imported without the condition"]
    _, main_part = read("a.py", f"if __name__ == '__main__':\n    {call}\n")
    assert main_part == []


def test_boxes_beside_a_timeline_that_was_asked_for_are_no_errors(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "a.xar"
    file.write_text(XAR.format(boxes=WAVE.format(name="Wave") + WAVE.format(name="Bow") + '<Box name="Say" id="2"/>'))
    assert main(["import", str(file), "--timeline", "Bow", "-o", str(tmp_path / "bow.yaml")]) == 0
    assert "box `Say` is left out" in capsys.readouterr().err


def test_a_broken_motion_keeps_nobody_from_importing_and_playing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    copytree(shipped_root() / "models", tmp_path / "models")
    (tmp_path / "lumen.yaml").write_bytes((shipped_root() / "lumen.yaml").read_bytes())
    (tmp_path / "motions").mkdir()
    (tmp_path / "motions" / "broken.yaml").write_text("keyframes: [{at: 1s, joints: {Headyaw: 0}}]\n")
    (tmp_path / "nod.motion").write_text(
        "#WEBOTS_MOTION,V1.0,HeadPitch\n00:01:000,Pose1,0.3\n00:01:020,Pose2,-0.3\n00:02:000,Pose3,0\n"
    )
    monkeypatch.chdir(tmp_path)
    assert main(["import", "nod.motion", "-o", "motions/nod.yaml"]) == 0
    assert (
        "motions/nod.yaml:1:1 warning[too-fast] `HeadPitch` would have to move at up to 4.2 times the speed limit"
        in capsys.readouterr().err
    )
    assert main(["import", "nod.motion", "--retime", "-o", "motions/nod.yaml"]) == 0
    assert "too-fast" not in capsys.readouterr().err
    assert main(["play", "broken"]) == 1
    assert "motions/broken.yaml:1:31" in capsys.readouterr().err
    assert main(["play", "nod"]) == 0
    assert "finished, on its feet" in capsys.readouterr().out
