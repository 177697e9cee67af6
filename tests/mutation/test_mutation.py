"""Whatever becomes of the shipped project, lint says what is wrong, or it runs."""

from statistics import fmean

import pytest

from tests.mutation.__main__ import WELL, survey, table

SEED = 20_000


@pytest.mark.slow
def test_two_hundred_mutants() -> None:
    counts, misses, said = found = survey(SEED, 200, stories=1)
    assert not misses, [(mutant.number, mutant.difference, outcome) for mutant, outcome in misses]
    assert counts.total() == 200
    assert len(said) > 80
    assert found.findings < 1.1  # one mistake is told once, not wherever it shows
    outcomes = {what: sum(n for (_, w), n in counts.items() if w == what) for what in WELL}
    assert outcomes["error found"] > 80  # mutants that are no better than the original would prove nothing
    assert outcomes["clean, and runs"] > 20
    assert len({kind for kind, _ in counts}) > 15


@pytest.mark.soak
def test_ten_thousand_mutants() -> None:
    counts, misses, said = survey(1_000_000, 10_000, stories=2)
    print(table(counts))  # noqa: T201
    print(f"{counts.total():,} mutants, {len(misses)} misses, {fmean(said):.2f} findings of a mistake")  # noqa: T201
    assert not misses, [(mutant.number, mutant.difference, outcome) for mutant, outcome in misses[:5]]
