"""The tour in simulation: nothing stands still for a second while the robot is awake (`benchmarks/alive.py`)."""

import pytest
from benchmarks.alive import measured

import lumen
from tests import ROOT

PROJECT = lumen.load(ROOT)


@pytest.mark.soak
@pytest.mark.parametrize("story", ["visitor", "indonesian"])
def test_nothing_is_still_for_a_second(story: str) -> None:
    whole, trunk, head, texts = measured(PROJECT, story)
    for moved in (whole, trunk, head):
        assert moved.time > 30.0
        assert moved.longest <= 1.0
    assert whole.still < 0.05 * whole.time
    assert trunk.still < 0.05 * trunk.time
    assert texts
