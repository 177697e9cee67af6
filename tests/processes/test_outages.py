"""A visitor lives through outages: `benchmarks/faults.py`, in a sample and in full."""

import sys

import pytest

from tests import ROOT
from tests.guarded import run_guarded

BENCHMARK = ROOT / "benchmarks/faults.py"


def outages(*words: object) -> str:
    """Return the benchmark's output, after checking that it succeeded."""
    done = run_guarded([sys.executable, BENCHMARK, *words], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return str(done.stdout)


@pytest.mark.soak  # tests/processes/test_faults.py kills brains in `make test`
@pytest.mark.xdist_group("outages")  # it waits most of the time
def test_an_explanation_goes_on_after_the_brain_was_killed_and_killed_again() -> None:
    said = outages("--parts", "brain", "--faults", "killed", "--moments", "explain")
    assert "2 of 2 go on" in said


@pytest.mark.soak
@pytest.mark.xdist_group("outages")
def test_all_outages_at_all_moments_with_physics() -> None:
    sys.stdout.write(outages("--robot", "simulation"))
