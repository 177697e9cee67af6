"""The law of importers: their output loads and behaves as the original, or a report names each difference.

Foreign files, generated and damaged ones, go through `lumen import`; generated charts are run by XState beside us.
"""

import json
from collections.abc import Mapping
from pathlib import Path
from random import Random
from typing import Any

import pytest

from lumen.cli.main import main
from lumen.features.formats_charts.xstate import read_xstate
from lumen.fuzzy import Controller
from lumen.motion import Motion
from lumen.statechart import Machine
from tests.attack.files import foreign_file
from tests.features.formats_charts.test_foreign_charts import way
from tests.features.formats_charts.test_xstate_runs import by_xstate

EVENTS = ("E", "F", "G")
ACTOR = "xstate.done.actor.act"


def stranger(random: Random) -> dict[str, Any]:
    """Return a random XState chart: all spellings of histories, actors, final regions, targets by name, path and id."""
    names: list[str] = []
    root = _state(random, "m", 3, names)
    while not root.get("states"):
        names.clear()
        root = _state(random, "m", 3, names)
    _lead(random, root, "m", names)
    return {**root, "id": "m"}


def _state(random: Random, path: str, levels: int, names: list[str], region: bool = False) -> dict[str, Any]:
    if levels == 0 or (levels < 3 and random.random() < 0.5):
        ends = levels < 2 and random.random() < (0.3 if region else 0.15)
        return {"type": "final"} if ends else {}
    keys = random.sample("abcd", random.randrange(1, 4))
    parallel = levels < 3 and random.random() < 0.35
    states = {}
    for key in keys:
        names.append(f"{path}.{key}")
        states[key] = _state(random, f"{path}.{key}", levels - 1, names, parallel)
    if random.random() < 0.4:
        names.append(f"{path}.h")
        states["h"] = dict(random.choice(HISTORIES))
        if not parallel and random.random() < 0.3:
            states["h"]["target"] = random.choice(keys)
    if parallel:
        return {"type": "parallel", "states": states}
    return {"initial": random.choice([keys[0], {"target": keys[0]}]), "states": states}


HISTORIES: tuple[Mapping[str, Any], ...] = (
    {"history": True},
    {"history": "shallow"},
    {"history": "deep"},
    {"type": "history"},
    {"type": "history", "history": "deep"},
)


def _lead(random: Random, state: dict[str, Any], path: str, names: list[str], region: bool = False) -> None:
    """Give the state transitions, and at times an actor; each end leads to a later state, so that no run is endless."""
    if state.get("type") in ("final", "history") or "history" in state:
        return
    rows: dict[str, Any] = {}
    for event in EVENTS:
        if random.random() < 0.5:
            rows[event] = {"target": f"#{random.choice(names)}"} | ({"reenter": True} if random.random() < 0.2 else {})
    if rows:
        state["on"] = rows
    later = [n for n in names[names.index(path) + 1 if path in names else 0 :] if not n.startswith(f"{path}.")]
    later = [name for name in later if not name.endswith(".h")]
    if state.get("states") and later and not region and random.random() < 0.5:
        state["onDone"] = f"#{random.choice(later)}"
    if random.random() < 0.2:
        state["invoke"] = {"id": "act", "src": "act", "onDone": f"#{random.choice(names)}"}
    for key, child in state.get("states", {}).items():
        _lead(random, child, f"{path}.{key}", names, region or state.get("type") == "parallel")


def lawful(seeds: range) -> tuple[int, int]:
    """Count the generated charts that behave as in XState, and those imported with a warning of a difference."""
    charts, sequences = [], []
    for seed in seeds:
        random = Random(seed)
        charts.append(stranger(random))
        sequences.append([random.choice((*EVENTS, ACTOR)) for _ in range(8)])
    rows = [{"config": c, "events": e} for c, e in zip(charts, sequences, strict=True)]
    same = told = 0
    for seed, chart, events, seen in zip(seeds, charts, sequences, by_xstate(rows), strict=True):
        if seen is None:
            continue  # XState has no meaning for it
        data, said = read_xstate("chart.json", json.dumps(chart).encode(), "chart")
        found = way(Machine.from_dict(data), events)
        if found == [sorted(states) for states, _ in seen]:
            same += 1
        else:
            others = [d for d in said if "invoke" not in d.message]
            assert others, (seed, events, found, seen)
            told += 1
    return same, told


def test_a_generated_chart_goes_where_xstate_goes_or_it_was_said() -> None:
    same, told = lawful(range(400))
    assert same > 200
    assert told < same


@pytest.mark.parametrize("part", range(4))
def test_what_is_written_loads(part: int, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Damaged charts, motions and controllers become a file that loads, or one line and no file."""
    written = 0
    for seed in range(part * 60, part * 60 + 60):
        name, content = foreign_file(Random(seed))
        (tmp_path / name).write_bytes(content)
        out = tmp_path / f"{seed}.yaml"
        code = main(["import", str(tmp_path / name), "-o", str(out)])
        told = capsys.readouterr().err
        assert out.exists() == (code in (0, 1)), (seed, told)
        assert code != 2 or told.count("\n") == 1, (seed, told)
        if out.exists():
            written += 1
            loads(out, name)
    assert written


def loads(out: Path, name: str) -> None:
    if name.endswith((".scxml", ".json")):
        Machine.load(out)
    elif name.endswith((".fll", ".fcl", ".fis")):
        Controller.load(out)
    else:
        Motion.load(out)
