"""A reload is data too: the same events and the same bundles, in the order journaled, give the same steps."""

from pathlib import Path
from typing import Any

import pytest

from lumen.interpreters.migration import MigrationPlan
from lumen.interpreters.statechart import Snapshot, Step
from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.rules import check_files
from lumen.runtime.runtime import Runtime
from tests.live.shows import Live

FINE = "en: [I am glad to hear that.,"


@pytest.mark.slow
def test_a_trace_replays_across_reloads_to_the_same_steps(copy: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    live = Live(copy)
    runtime, trace = live.show.loop.runtime, list[tuple[str, float, Any]]()
    tick, apply = runtime.tick, runtime.apply

    def ticked(now: float, events: Any) -> Any:
        trace.append(("tick", now, list(events)))
        return tick(now, trace[-1][2])

    def applied(project: Project, planned: Any) -> None:
        trace.append(("reload", live.show.loop.clock.now(), project.hash))
        apply(project, planned)

    first, began = live.show.loop.project, live.show.loop.runtime.snapshot
    steps: list[Step] = []
    observe = runtime._observe
    monkeypatch.setattr(runtime, "_observe", lambda step: (steps.append(step), observe(step)))
    monkeypatch.setattr(runtime, "tick", ticked)
    monkeypatch.setattr(runtime, "apply", applied)
    live.greet()
    live.edit(FINE, "en: [How wonderful.,")
    live.until_told("are active")
    live.speak("my name is Ada", "how_are_you")
    live.edit("en: Never mind.", "en: No problem.")
    live.until(lambda: live.verdicts.count("applied") == 2)
    live.speak("fine", "offer")
    live.show.close()
    keeper = live.records.keeper
    assert keeper
    journaled = [entry["after"] for entry in live.records.journal.entries() if entry["verdict"] == "applied"]
    assert [what for kind, _, what in trace if kind == "reload"] == journaled
    assert _replayed(first, began, trace, live, journaled) == [step.snapshot for step in steps]


def _replayed(first: Project, began: Snapshot, trace: Any, live: Live, hashes: list[str]) -> list[Any]:
    """The snapshots of all steps when everything happens again, from the files that were kept."""
    assert live.records.keeper
    bundles = {}
    for hash in hashes:
        files = live.records.keeper.files(hash)
        assert files
        bundles[hash] = check_files(live.folder, files)[0]
    again: list[Any] = []
    runtime = Runtime(first, lambda step: again.append(step.snapshot))
    runtime.start(0.0, epoch=began.epoch, timezone=began.timezone)
    again.clear()
    for kind, now, what in trace:
        if kind == "tick":
            runtime.tick(now, [Event(*event) for event in what])
        else:
            plan = runtime.plan(bundles[what], now)
            assert isinstance(plan, MigrationPlan)
            runtime.apply(bundles[what], plan.snapshot)
    return again
