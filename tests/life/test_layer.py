"""The robot's life as the layer adds it: gentle, repeatable, and absent from parts that a command moves."""

from collections.abc import Collection
from dataclasses import replace
from itertools import pairwise

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import lumen
from lumen.language.body_parts import ARMS, HEAD, LEGS, WHOLE_BODY
from lumen.language.commands import Say
from lumen.language.life import STILL_STYLE, Asides, Glances, LifeStyle, Nods, Settles, Sway
from lumen.motion.life import SETTLE_SLOPE, SPEED_SHARE, settle, vigour
from lumen.robot.life_layer import LifeLayer
from tests import ROOT

PROJECT = lumen.load(ROOT)
BODY = PROJECT.body
DT = 0.01

STYLES = st.builds(
    LifeStyle,
    st.just("any"),
    st.lists(
        st.builds(
            Sway,
            st.sampled_from(["one", "two"]),
            st.floats(0.1, 20.0),
            st.dictionaries(st.sampled_from(sorted(BODY.joints)), st.floats(-0.5, 0.5), min_size=1, max_size=4),
            st.booleans(),
        ),
        max_size=3,
    ).map(tuple),
    st.none() | st.builds(Glances, st.floats(0.5, 9.0), st.floats(0, 1), st.floats(0, 0.5), st.floats(0, 2)),
    st.none() | st.builds(Nods, st.floats(0.8, 9.0), st.floats(0, 0.3)),
    asides=st.none() | st.builds(Asides, st.floats(0, 1), st.floats(0, 0.5), st.floats(0, 2)),
    settles=st.none() | st.builds(Settles, st.just({"RElbowRoll": 0.3, "HeadPitch": 0.2}), st.floats(0.1, 3.0)),
)
PARTS = st.frozensets(st.sampled_from(sorted(WHOLE_BODY)))


def live(
    layer: LifeLayer, begin: float, seconds: float, free: Collection[str], level: float = 1.0
) -> list[dict[str, float]]:
    ticks = range(round(begin / DT), round((begin + seconds) / DT))
    return [dict(layer.advance(tick * DT, DT, free, lambda _part: level)) for tick in ticks]


def lively() -> LifeLayer:
    layer = LifeLayer(BODY)
    layer.style = PROJECT.life["lively"]
    return layer


@settings(max_examples=60, deadline=None)
@given(STYLES, st.integers(0, 5), st.lists(PARTS, min_size=2, max_size=4))
def test_whatever_the_style_no_joint_is_faster_than_its_share(
    style: LifeStyle, seed: int, owners: list[Collection[str]]
) -> None:
    layer, before = LifeLayer(BODY, seed), dict[str, float]()
    layer.style = style
    for i, free in enumerate(owners):
        for offsets in live(layer, i * 0.5, 0.5, free):
            for joint in offsets.keys() | before.keys():
                way = abs(offsets.get(joint, 0.0) - before.get(joint, 0.0))
                assert way <= SPEED_SHARE * BODY.joints[joint].speed * DT + 1e-4
            before = offsets


@settings(max_examples=60, deadline=None)
@given(STYLES, PARTS, st.floats(0, 1000))
def test_what_a_command_moves_is_left_alone(style: LifeStyle, free: Collection[str], now: float) -> None:
    layer = LifeLayer(BODY)
    layer.style = style
    wanted = layer.wanted(now, free, lambda _part: 1.0)
    assert not {j for part in WHOLE_BODY - set(free) for j in BODY.parts[part]} & wanted.keys()
    if LEGS not in free:
        assert wanted.keys() <= set(BODY.parts[HEAD])


def test_the_arms_let_go_when_a_motion_takes_them_and_come_back() -> None:
    layer = lively()
    live(layer, 0.0, 5.0, WHOLE_BODY)
    after = live(layer, 5.0, 2.0, {HEAD, LEGS})[-1]
    assert not after.keys() & set(BODY.parts[ARMS])
    assert live(layer, 7.0, 2.0, WHOLE_BODY)[-1].keys() >= {"LShoulderRoll", "RElbowRoll"}


def test_the_same_seed_is_the_same_life_and_another_one_another() -> None:
    def life(seed: int) -> list[dict[str, float]]:
        layer = LifeLayer(BODY, seed)
        layer.style = PROJECT.life["calm"]
        return live(layer, 0.0, 3.0, WHOLE_BODY)

    assert life(1) == life(1) != life(2)


def test_still_is_still() -> None:
    layer = LifeLayer(BODY)
    assert not any(live(layer, 0.0, 5.0, WHOLE_BODY))
    layer.style = PROJECT.life["lively"]
    live(layer, 5.0, 5.0, WHOLE_BODY)
    layer.style = STILL_STYLE
    assert live(layer, 10.0, 3.0, WHOLE_BODY)[-1] == {}


@pytest.mark.parametrize("name", sorted(PROJECT.life))
def test_a_shipped_style_never_leaves_the_limits_nor_stops_for_a_second(name: str) -> None:
    layer = LifeLayer(BODY)
    layer.style = PROJECT.life[name]
    frames = live(layer, 0.0, 60.0, WHOLE_BODY)
    stand = BODY.postures["Stand"]
    for offsets in frames[::10]:
        for joint, offset in offsets.items():
            assert BODY.joints[joint].minimum <= stand[joint] + offset <= BODY.joints[joint].maximum
    moved = [
        max(abs(b[j] - a.get(j, 0.0)) for j in b) for a, b in zip(frames[100:-100:100], frames[200::100], strict=False)
    ]
    assert min(moved) > 0.0017  # an encoder's step of 0.1 degrees


def test_it_looks_where_it_was_touched() -> None:
    layer = lively()
    layer.touched("HandLeftBack", 10.0)
    assert layer.wanted(11.0, WHOLE_BODY, lambda _part: 1.0).get("HeadYaw", 0.0) > 0.4


def test_it_calms_down_where_it_is_warm_or_the_battery_low() -> None:
    assert vigour(40.0, 80.0) == 1.0
    assert 0.0 < vigour(66.0, 80.0) < 1.0
    assert vigour(75.0, 80.0) == 0.0
    assert 0.0 < vigour(40.0, 15.0) < 1.0
    assert vigour(40.0, 3.0) == 0.0
    layer = lively()
    warm = max(abs(angle) for frame in live(layer, 0.0, 10.0, WHOLE_BODY, 0.3) for angle in frame.values())
    well = max(abs(angle) for frame in live(lively(), 0.0, 10.0, WHOLE_BODY) for angle in frame.values())
    assert warm < 0.5 * well


def test_the_eyes_blink_and_have_the_colour_of_the_style() -> None:
    layer = LifeLayer(BODY)
    layer.style = PROJECT.life["listening"]
    seen = [layer.eyes(tick * DT) for tick in range(6000)]
    assert set(seen) == {"off", "deepskyblue"}
    assert 0.02 < seen.count("off") / len(seen) < 0.08


def test_it_looks_towards_a_sound_and_not_towards_its_own_voice() -> None:
    layer = lively()
    layer.style = replace(layer.style, sways=(), glances=None, settles=None, asides=None)
    layer.heard(0.7, 0.1, 10.0)
    wanted = layer.wanted(11.0, {HEAD}, lambda _part: 1.0)
    assert (wanted["HeadYaw"], wanted["HeadPitch"]) == pytest.approx((0.7, 0.1))
    layer.say(Say("That was me.", "en"), 2.0, 20.0)
    layer.heard(0.7, 0.1, 21.0)
    assert layer.wanted(22.5, {HEAD}, lambda _part: 1.0)["HeadYaw"] == 0.0
    layer.heard(-3.0, 0.1, 30.0)
    assert layer.wanted(31.0, {HEAD}, lambda _part: 1.0)["HeadYaw"] == pytest.approx(-1.0)


def turned(layer: LifeLayer, now: float) -> float:
    return layer.wanted(now, {HEAD}, lambda _part: 1.0)["HeadYaw"]


def test_it_keeps_looking_at_somebody_who_goes_on_speaking() -> None:
    layer = lively()
    layer.style = replace(layer.style, sways=(), glances=None, settles=None, asides=None)
    angles = []
    for tick in range(1000):
        if tick % 40 == 0 and tick < 600:
            layer.heard(0.7, 0.0, tick * DT)
        angles.append(turned(layer, tick * DT))
    steps = [later - before for before, later in pairwise(angles)]
    assert min(angles[60:600]) == pytest.approx(0.7)
    assert max(map(abs, steps)) < 0.03
    assert angles[-1] == 0.0


def test_a_sound_beside_the_turned_head_is_beside_it() -> None:
    layer = lively()
    layer.style = replace(layer.style, sways=(), glances=None, settles=None, asides=None)
    layer.heard_by_head(0.7, 0.0, 0.0)
    for tick in range(100):
        layer.advance(tick * DT, DT, {HEAD}, lambda _part: 1.0)
    layer.heard_by_head(0.0, 0.0, 1.0)
    assert turned(layer, 1.5) == pytest.approx(0.7, abs=0.05)
    layer.heard_by_head(-0.5, 0.0, 1.5)
    assert turned(layer, 2.0) == pytest.approx(0.2, abs=0.05)


def test_it_looks_aside_before_an_answer_and_not_before_the_next_sentence() -> None:
    layer = lively()
    free = {HEAD}
    alone = replace(layer.style, sways=(), glances=None, settles=None)
    layer.style = alone

    def turned(now: float) -> tuple[float, float]:
        wanted = layer.wanted(now, free, lambda _part: 1.0)
        return abs(wanted["HeadYaw"]), wanted["HeadPitch"]

    layer.say(Say("Let me see.", "en"), 2.0, 10.0)
    assert alone.asides
    assert turned(10.8) == pytest.approx((alone.asides.yaw, -alone.asides.pitch))
    assert layer.eyes(10.8) in ("gold", "off")
    assert layer.eyes(11.9) in ("turquoise", "off")
    assert turned(11.7) == (0.0, 0.0)
    layer.say(Say("It is over there.", "en"), 2.0, 12.1)
    assert turned(12.9) == (0.0, 0.0)
    layer.hush(14.0)
    assert layer.eyes(14.1) in ("", "off")


def test_it_nods_to_what_others_say_and_not_to_its_own_words() -> None:
    layer = LifeLayer(BODY)
    layer.style = LifeStyle("nods", nods=Nods(1.0, 0.1))

    def nods(begin: float) -> float:
        return max(layer.wanted(begin + t / 50, {HEAD}, lambda _part: 1.0)["HeadPitch"] for t in range(100))

    layer.say(Say("Who are you?", "en"), 2.0, 10.0)
    assert nods(10.0) == 0.0
    assert nods(12.0) > 0.09


@given(st.floats(0.3, 5.0), st.floats(0.0, 30.0))
def test_what_settles_goes_a_tenth_beyond_its_rest_at_most(takes: float, since: float) -> None:
    settles = Settles({"HeadPitch": 1.0}, takes)
    level = settle(settles, since)["HeadPitch"]
    assert 0.0 <= level <= 1.1
    assert level == pytest.approx(1.0, abs=0.1) or since < takes
    assert abs(settle(settles, since + 1e-3)["HeadPitch"] - level) <= SETTLE_SLOPE / takes * 1e-3 + 1e-9


def test_arms_settle_once_a_motion_is_over() -> None:
    layer = LifeLayer(BODY)
    layer.style = LifeStyle("settles", settles=Settles({"LElbowRoll": -0.1}, 1.0))
    assert live(layer, 0.0, 3.0, WHOLE_BODY)[-1]["LElbowRoll"] == pytest.approx(-0.1, abs=0.02)
    assert not live(layer, 3.0, 3.0, {HEAD, LEGS})[-1]
    back = [frame.get("LElbowRoll", 0.0) for frame in live(layer, 6.0, 3.0, WHOLE_BODY)]
    assert abs(back[10]) < 0.02
    assert back[-1] == pytest.approx(-0.1, abs=0.02)
