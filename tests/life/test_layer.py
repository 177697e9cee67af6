"""The robot's life as the layer adds it: gentle, the same again, and never where a command moves the robot."""

from collections.abc import Collection
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import lumen
from lumen.interpreters.life import SPEED_SHARE, vigour
from lumen.language.life import STILL_STYLE, Glances, LifeStyle, Nods, Sway
from lumen.robots.body_parts import ARMS, HEAD, LEGS, WHOLE_BODY
from lumen.robots.life_layer import LifeLayer

ROOT = Path(__file__).parents[2]
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
