"""Edits in every way that editors save, under load: nothing lost, nothing mixed, nothing grows."""

import pytest
from benchmarks.reload import Outcome, soak


def holds(found: Outcome) -> None:
    assert found.wrong == []
    assert found.lost == 0
    assert found.unanswered == 0
    assert found.applied + found.refused >= found.edits
    assert found.threads[1] <= found.threads[0]
    assert found.handles[1] <= found.handles[0]


@pytest.mark.process
@pytest.mark.slow
def test_fifteen_edits_under_load() -> None:
    holds(soak(15, quiet=1.0))  # a writer that the machine holds back for as long leaves a half of its edit to be used


@pytest.mark.soak
@pytest.mark.parametrize("url", ["memory", pytest.param("amqp", marks=pytest.mark.broker)])
def test_a_thousand_edits_under_load(url: str, request: pytest.FixtureRequest) -> None:
    found = soak(1000, "memory://" if url == "memory" else request.getfixturevalue("broker").url)
    holds(found)
    assert found.missed <= found.beside + found.ticks // 1000
    assert found.growth < 5.0
