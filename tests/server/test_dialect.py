"""Commands that the modules of 2015 wrote, translated; and the replies for impossible ones."""

from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from lumen.errors import RobotError
from lumen.language.commands import Language, Leds, Move, Posture, Rest, Say, Stop, Wake, Walk
from lumen.language.motions import MotionDefinition
from lumen.ports import Aim, Perform, Record
from lumen.robot.command_codec import decode_command
from tests.exhibits import project
from tests.tables import for_each

PROJECT = project()


def order(method: str, /, **parameter: Any) -> dict[str, Any]:
    return {"type": "motion", "method": method, "parameter": parameter}


@for_each(
    ("body", "command"),
    [
        (order("wakeup"), Wake()),
        ({"type": "MOTION", "Method": "WakeUp", "parameter": None}, Wake()),
        ({"method": "rest"}, Rest()),
        ({"type": "posture", "method": "stopMove"}, Stop()),
        (order("moveInit"), Posture("StandInit")),
        (order("moveTo", x=0.2, y=0, tetha=0), Walk(0.2, 0.0, 0.0)),
        (order("moveto", x=0.2, theta=1), Walk(0.2, 0.0, 1.0)),
        (order("move", x=0.1, y=-0.02, tetha=0.3), Move(0.1, -0.02, 0.3)),
        (order("moveToward", x=0.5, theta=-7), Move(0.5 * (0.081 / (0.04 + 0.3)), 0.0, -(0.4 / (0.04 + 0.3)))),
        (order("goToPosture", postureName="Stand", speed=0.8), Posture("Stand", 0.8)),
        (order("gotoposture", postureName="crouch"), Posture("Crouch", 0.5)),
        (order("setAngles", jointNames=["HeadYaw", "HeadPitch"], angles=[0.5, -0.1], speed=0.2),
         Aim({"HeadYaw": 0.5, "HeadPitch": -0.1}, 0.2)),
        (order("setangles", jointNames="HeadYaw", angles=0.5), Aim({"HeadYaw": 0.5})),
        (order("Leds", colours={"eyes": "blue", "chest": "#12A0ff"}), Leds({"eyes": "blue", "chest": "#12A0ff"})),
        (order("setangles", jointNames=["LHipPitch ", "LAngklePitch"], angles=[0.1, 0.2]),
         Aim({"LHipPitch": 0.1, "LAnklePitch": 0.2})),
        (order("setangles", jointNames=["HeadYaw"], angles=[100]), Aim({"HeadYaw": 2.0})),
        (order("changeangle", jointNames=["HeadYaw"], angles=[-0.2]), Aim({"HeadYaw": pytest.approx(0.3)})),
        (order("openhand", handName="RHand"), Aim({"RHand": 1.0})),
        (order("closeHand", handName="RHand"), Aim({"RHand": 0.0})),
        (order("say", text="Hello", language="English"), Say("Hello", "en")),
        (order("say", text="Halo"), Say("Halo", "")),
        (order("setLanguage", language="Indonesian"), Language("id")),
        ({"type": "audiodevice", "method": "record", "parameter": {"recordingName": "r1"}}, Record("r1", 5.0)),
        (order("record", duration=2), Record("recording", 2.0)),
    ],
)  # fmt: skip
def test_methods(body: dict[str, Any], command: object) -> None:
    assert decode_command(body, PROJECT, lambda: {"HeadYaw": 0.5}) == command


@for_each(
    ("method", "motion"),
    [("goodbye", "goodbye"), ("dance", "dance"), ("Dancing", "dance"), ("sing", "sing"), ("singing", "sing"),
     ("photopose", "photo")],
)  # fmt: skip
def test_the_papers_names_and_the_sources_names_play_the_motion(method: str, motion: str) -> None:
    assert decode_command({"method": method}, PROJECT) == Perform(PROJECT.motions[motion])


def test_a_motion_hides_no_method_and_an_alias_hides_no_motion() -> None:
    names = ("rest", "StopMove", "dancing", "dance", "Wave", "PhotoPose")
    motions = {name: MotionDefinition(name, 1.0, {}) for name in names}
    other = project(motions=motions)
    assert decode_command({"method": "rest"}, other) == Rest()
    assert decode_command({"method": "stopmove"}, other) == Stop()
    assert decode_command({"method": "dancing"}, other) == Perform(motions["dancing"])
    assert decode_command({"method": "dance"}, other) == Perform(motions["dance"])
    assert decode_command({"method": "photopose"}, other) == Perform(motions["PhotoPose"])
    for method in ("Wave", "wave", " WAVE "):
        assert decode_command({"method": method}, other) == Perform(motions["Wave"])


@pytest.mark.parametrize("number", [10**400, float("inf"), float("nan"), -(2**64)])
def test_a_number_beyond_all_bounds_is_refused(number: float) -> None:
    for body in (order("moveto", x=number), order("setangles", jointNames="HeadYaw", angles=number)):
        with pytest.raises(RobotError, match="must be a number"):
            decode_command(body, PROJECT)


@for_each(
    "body",
    [
        order("a\nb"),
        order("gotoposture", postureName="a\nb"),
        order("say", text="", language="a\nb"),
        order("setangles", jointNames="a\nb", angles=1),
        order("setangles", jointNames="HeadYaw\n", angles=""),
        order("leds", colours={"eyes\n": "a\nb"}),
        order("leds", colours={"eyes": "a\nb"}),
    ],
)
def test_what_a_stranger_wrote_stays_in_one_line(body: Any) -> None:
    with pytest.raises(RobotError) as caught:
        decode_command(body, PROJECT)
    assert "\n" not in str(caught.value)


@for_each(
    ("body", "says"),
    [
        (order("danse"), "no method `danse`: did you mean `dance`?"),
        (order("x" * 10_000), "no method"),
        ({"type": "motion"}, "needs a `method`"),
        ({"method": 1}, "needs a `method`"),
        ("dance", "must be an object"),
        (None, "must be an object"),
        ({"method": "moveto", "parameter": [1]}, "`parameter` of a command must be an object"),
        (order("moveto", x="near"), "`x` of `moveto` must be a number"),
        (order("moveto", x=True), "must be a number"),
        (order("gotoposture", postureName="Stnd"), "no posture `Stnd`: did you mean `Stand`?"),
        (order("gotoposture"), "`posturename` of `gotoposture` must be a string"),
        (order("setangles", jointNames=["HeadYow"], angles=[0]), "no joint `HeadYow`: did you mean `HeadYaw`?"),
        (order("setangles", jointNames=["HeadYaw"], angles=[]), "as many `angles`"),
        (order("setangles", jointNames=["HeadYaw"], angles=["a"]), "must be a number"),
        (order("changeangle", jointNames=["HeadYaw"], angles=[0.1]), "the angle of `HeadYaw` is unknown"),
        (order("say", text=5), "must be a string"),
        (order("say", text="x", language="Klingon"), "the robot does not speak `klingon`"),
        (order("setlanguage"), "must be a string"),
        (order("setstiffnesses", jointNames=["HeadYaw"]), "this robot cannot do"),
        (order("leds"), "needs `colours`"),
        (order("leds", colours={}), "at least one light"),
        (order("leds", colours={"eye": "red"}), "no light `eye`: did you mean `eyes`?"),
        (order("leds", colours={"eyes": "bleu"}), "no colour `bleu`: did you mean `blue`?"),
        (order("leds", colours={"eyes": "#12g"}), "`#12g` is not a colour"),
        (order("leds", colours={"eyes": 5}), "no colour `5`"),
        (order("leds", colours={"eyes": "red"}, duration=61), "0 to 60 s, not 61 s"),
        (order("record", recordingName=5), "must be a string"),
        (order("record", recordingName="a", duration=60), "between 0.1 and 20 s, not 60"),
    ],
)
def test_what_cant_be_done_is_said(body: Any, says: str) -> None:
    with pytest.raises(RobotError) as caught:
        decode_command(body, PROJECT)
    assert says in str(caught.value)
    assert len(str(caught.value)) < 300


METHODS = st.sampled_from(["moveto", "setangles", "say", "gotoposture", "openhand", "dance", "setlanguage"]) | st.text()
VALUES = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text(),
    lambda v: st.lists(v, max_size=3) | st.dictionaries(st.text(), v, max_size=2),
    max_leaves=4,
)
NAMES = st.sampled_from(["x", "speed", "jointNames", "angles", "handName", "text", "language", "postureName"])


@pytest.mark.slow
@given(method=METHODS, parameter=st.dictionaries(NAMES, VALUES) | VALUES)
def test_whatever_comes_is_a_command_or_a_refusal(method: str, parameter: Any) -> None:
    try:
        decode_command({"method": method, "parameter": parameter}, PROJECT)
    except RobotError as error:
        assert "\n" not in str(error)  # noqa: PT017
