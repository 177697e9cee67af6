"""SCXML's Appendix D and the design's additions to it, rule by rule: one YAML file each."""

from pathlib import Path

import pytest

from lumen.statechart import Event, Snapshot, Step
from lumen.statechart.fast_path import FastPaths
from tests.statechart.table import CASES, play, read
from tests.tables import for_each


@for_each("path", CASES, ids=lambda path: path.stem)
@for_each("again", [False, True], ids=["first", "again"])
def test_rule(path: Path, again: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    if again:  # each step is repeated, so that the function specialized for it, if any, computes it
        step = FastPaths.step

        def thrice(self: FastPaths, snapshot: Snapshot, event: Event) -> Step | None:
            return [step(self, snapshot, event) for _ in range(3)][-1]

        monkeypatch.setattr(FastPaths, "step", thrice)
    case = read(path)
    for number, (expected, found) in enumerate(play(case)):
        for key in ("context",):
            if key in expected:
                found = {**found, key: {k: found[key][k] for k in expected[key]}}
        assert found == expected, f"{case['rule']} (step {number}: {case['steps'][number]})"
