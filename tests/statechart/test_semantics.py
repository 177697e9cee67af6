"""SCXML's Appendix D and what the design adds to it, rule by rule: one YAML file each."""

from pathlib import Path

import pytest

from tests.statechart.table import CASES, play, read


@pytest.mark.parametrize("path", CASES, ids=lambda path: path.stem)
def test_rule(path: Path) -> None:
    case = read(path)
    for number, (expected, found) in enumerate(play(case)):
        for key in ("context",):
            if key in expected:
                found = {**found, key: {k: found[key][k] for k in expected[key]}}
        assert found == expected, f"{case['rule']} (step {number}: {case['steps'][number]})"
