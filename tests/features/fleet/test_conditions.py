"""`abort-if`: the value of `before`, the place of errors, and conditions on unknown measures."""

import pytest

from lumen.features.fleet.rollouts.conditions import condition_faults, holds, meant
from tests.tables import for_each

MEASURES = {"falls": None, "errors": None}


@pytest.mark.parametrize(
    ("source", "expected"),
    [
        ("falls > 0", "context.now.falls > 0"),
        ("errors > 1.5 * before", "context.now.errors > 1.5 * context.before.errors"),
        ("falls > 0 || errors > before + 1", "context.now.falls > 0 || context.now.errors > context.before.errors + 1"),
        ("before.falls < 1 && falls > 2", "context.before.falls < 1 && context.now.falls > 2"),
    ],
)
def test_before_is_the_measure_that_it_is_compared_with(source: str, expected: str) -> None:
    assert meant(source, MEASURES) == expected
    assert condition_faults(source, MEASURES) == []


@for_each(
    ("source", "offset", "said"),
    [
        ("fals > 0", 0, "there is no measure `fals`"),
        ("falls > 0 || before", 13, "`before` has no measure to refer to here"),
        ("falls + errors > before", 17, "`before` has no measure to refer to here"),
        ("before.fals > 1", 0, "there is no measure `fals`"),
        ("falls >", 7, ""),
    ],
)
def test_what_can_not_be_computed_is_told_at_its_character(source: str, offset: int, said: str) -> None:
    fault = condition_faults(source, MEASURES)[0]
    assert fault.offset == offset
    assert said in fault.message
    assert bool(fault.hint) == bool(said)


@pytest.mark.parametrize(
    ("now", "before", "expected"),
    [
        ({"falls": 1.0}, {}, True),
        ({"falls": 0.0}, {}, None),
        ({"falls": 0.0, "errors": 3.0}, {"errors": 1.0}, True),
        ({"falls": 0.0, "errors": 1.0}, {"errors": 1.0}, False),
    ],
)
def test_what_is_certain_holds_whatever_is_not_known(
    now: dict[str, float], before: dict[str, float], expected: bool | None
) -> None:
    assert holds("falls > 0 || errors > 1.5 * before", MEASURES, now, before) is expected
