"""Each mutant of the shipped project is reported by lint, or it runs."""

from statistics import fmean

import pytest

from tests.mutation.__main__ import WELL, survey, table

pytestmark = pytest.mark.rest  # expensive

SEED = 20_000


@pytest.mark.slow
def test_thirty_mutants() -> None:
    counts, misses, said = survey(SEED, 30, stories=1)
    assert not misses, [(mutant.number, mutant.difference, outcome) for mutant, outcome in misses]
    assert counts.total() == 30
    assert len(said) > 10
    assert said.count(1) > 0.9 * len(said)  # one mistake is told once, not wherever it shows
    outcomes = {what: sum(n for (_, w), n in counts.items() if w == what) for what in WELL}
    assert outcomes["error found"] > 12  # mutants that are no better than the original would prove nothing
    assert outcomes["clean, and runs"] > 3
    assert len({kind for kind, _ in counts}) > 9


@pytest.mark.soak
def test_ten_thousand_mutants() -> None:
    counts, misses, said = survey(1_000_000, 10_000, stories=2)
    print(table(counts))  # noqa: T201
    print(f"{counts.total():,} mutants, {len(misses)} misses, {fmean(said):.2f} findings of a mistake")  # noqa: T201
    assert not misses, [(mutant.number, mutant.difference, outcome) for mutant, outcome in misses[:5]]
    assert fmean(said) < 1.1
