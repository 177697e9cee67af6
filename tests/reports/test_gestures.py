"""Gestures of other tools from public bug reports: each keeps its numbers, and omitted parts are listed."""

from pathlib import Path
from typing import Any

import pytest

import lumen
from lumen.cli.main import main
from lumen.language.diagnostics import Diagnostic
from lumen.project.formats.conversion_findings import LOST, ForeignFileError
from lumen.project.formats.importers import read_gesture
from lumen.project.packaged import shipped_root
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


@pytest.mark.parametrize("wrong", ['side="left" abscissaParam="5"', 'side="left" abscissaParam="x"'])
def test_a_tangent_that_is_left_out_does_not_bend_the_curve(wrong: str) -> None:
    tangent = f'value="30"><Tangent interpType="bezier" {wrong} ordinateParam="40" /></Key>'
    keys, found = read("box-library.xar", 'value="30" />', tangent)
    assert any(d.message.startswith("a tangent is left out") for d in found)
    assert keys == read("box-library.xar", "", "")[0]


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


def test_a_script_with_odd_numbers_and_escapes_shows_no_python_warning(recwarn: pytest.WarningsRecorder) -> None:
    assert script("shown = '\\d' if 1in nod else 0", "if True:", NOD)[0] == TWICE[:2]
    assert not recwarn.list
