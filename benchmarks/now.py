"""Measure the cost of one `{"ask": "now"}`: CPU time, medians. A console sends about 4 per second.

    python benchmarks/now.py

`taken` is the time in the tick itself, `told` the time that another thread needs afterwards. The tour is the shipped
one during a conversation. The large chart has 1,500 states, each with a guarded transition to the next; the wide one
has as many regions, which are all active at once.
"""

import json
from statistics import median
from time import process_time
from typing import Any

import lumen
from lumen.language.projects import Project
from lumen.run.activity_tracker import ActivityTracker
from lumen.run.approvals import Approvals
from lumen.run.exhibition import Exhibition
from lumen.run.now import NowView, moment
from lumen.statechart import Machine, initial

RUNS, SIZE = 31, 1500
ROW = "{:<34}{:>12}{:>12}{:>10}"


def chart(kind: str) -> dict[str, Any]:
    """Return a large or a wide chart."""
    states = {f"s{i}": {"on": {"go": _row(f"s{(i + 1) % SIZE}")}} for i in range(SIZE)}
    regions = {f"s{i}": {"on": {"go": {"guard": "context.n < 5"}}} for i in range(SIZE)}
    wide = {"all": {"type": "parallel", "states": regions}}
    return {"context": {"n": 0}, "states": states if kind == "large" else wide}


def _row(target: str) -> dict[str, Any]:
    return {"target": target, "guard": "context.n < 1000000000", "actions": {"assign": {"n": "context.n + 1"}}}


def tour() -> Exhibition:
    """Return the shipped tour, running, with a visitor."""
    exhibition = lumen.open(".")
    exhibition.send("face", {"x": 160, "y": 120})
    exhibition.run(1.0)
    return exhibition


def milliseconds(work: Any) -> float:
    """Return the median of several runs [ms], after one to warm up."""
    work()
    spent = []
    for _ in range(RUNS):
        start = process_time()
        work()
        spent.append(process_time() - start)
    return 1000 * median(spent)


def line(name: str, project: Project, snapshot: Any, activity: ActivityTracker, status: Any) -> None:
    """Print a row for one chart."""
    view = NowView()

    def take() -> Any:
        return moment(
            project, snapshot, 1.0, activity, position=1, approvals=Approvals(), model=None, events=0, status=status
        )

    taken, told = milliseconds(take), milliseconds(lambda: view.tell(take()))
    size = len(json.dumps(view.tell(take()))) / 1000
    print(ROW.format(name, f"{taken:.3f} ms", f"{told - taken:.2f} ms", f"{size:.0f} kB"))


def main() -> None:
    print(ROW.format("", "taken", "told", "size"))
    with tour() as exhibition:
        project, runtime = exhibition.project, exhibition.loop.runtime
        activity = ActivityTracker(lambda: project, lambda: runtime.snapshot, lambda: 1.0)
        activity.look()
        line("the shipped tour, in `greet`", project, runtime.snapshot, activity, exhibition.status)
    for kind in ("large", "wide"):
        machine = Machine.from_dict(chart(kind))
        snapshot = initial(machine).snapshot
        whole = Project("", "", "NAO", project.body, "", "b", {"b": machine})
        activity = ActivityTracker(lambda whole=whole: whole, lambda snapshot=snapshot: snapshot, lambda: 1.0)  # type: ignore[misc]
        activity.look()
        line(f"a {kind} chart of {SIZE:,} states", whole, snapshot, activity, dict)


if __name__ == "__main__":
    main()
