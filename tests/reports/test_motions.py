"""Motions and bodies of other people's bug reports: each keeps its numbers, and what is left out is listed."""

from pathlib import Path
from typing import Any

import lumen
from lumen.formats.conversion_findings import LOST
from lumen.formats.gestures import read_gesture
from lumen.language.diagnostics import Diagnostic
from lumen.loading.packaged import shipped_root
from tests.tables import for_each

INPUTS = Path(__file__).parent / "inputs" / "motions"
BODY = lumen.load(shipped_root()).body


def read(name: str, old: str = "", new: str = "", timeline: str = "") -> tuple[list[dict[str, Any]], list[Diagnostic]]:
    """The keyframes of an input in which `old` is `new`, and the findings."""
    text = (INPUTS / name).read_text("utf-8")
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
def test_a_hand_is_an_opening_whatever_its_unit(name: str, old: str, new: str) -> None:
    keys, found = read(name, old, new)
    assert keys == WAVE
    assert [d.message[:18] for d in found] == (["`unit` of `RHand` i"[:18]] if "unit" in new else [])


def test_an_arm_stays_in_degrees_whatever_its_unit() -> None:
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
        ('mute="0"', 'mute="true"', "`RShoulderPitch` is not muted: `mute` is `true`"),
        ('enable="1"', 'enable="yes"', "`enable` is `yes`: the timeline counts as switched on"),
        ('xar_version="3"', 'xar_version="4"', "`xar_version` is 4: the file is read as one of version 3"),
        (
            'value="30" />',
            'value="30"><Tangent side="left" interpType="bezir" abscissaParam="-1" /></Key>',
            "`RShoulderPitch` moves here by `bezir`, which is unknown",
        ),
        (
            'value="30" />',
            'value="30"><Tangent side="middle" interpType="linear" /></Key>',
            "a tangent of `RShoulderPitch` is `middle`",
        ),
        (
            '<Box name="root" id="-1">',
            '<Box name="root" id="-1"><script language="4"><content>self.x()</content></script>',
            "the script of the box `root` is left out",
        ),
    ],
)
def test_what_a_xar_is_not_read_for_is_listed(old: str, new: str, message: str) -> None:
    _, found = read("box-library.xar", old, new)
    assert message in [d.message for d in found]
