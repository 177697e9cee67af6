"""Read `replay` and `budget` under `reload:` of lumen.yaml as a `ReplayCheck`."""

from collections.abc import Mapping
from typing import Any

from lumen.language.diagnostics import WARNING, Code
from lumen.language.replay_check import DEFAULT_BUDGET, MAX_BUDGET, ReplayCheck
from lumen.project.document_report import DocumentReport
from lumen.project.retention import read_journal
from lumen.project.routes import duration
from lumen.project.units import BAD_DURATION

IDLE_CHECK = Code(
    "idle-check",
    "reload",
    WARNING,
    "saved files can't be checked against recorded visits: the visits or a setting are missing",
)

HOW = "add `replay: warn` or `replay: refuse`, or delete it"


def read_replay_check(data: Mapping[str, Any], report: DocumentReport) -> ReplayCheck:
    """Return how saved files are checked against recorded visits.

    A setting without effect is reported. A faulty `budget` is reported and replaced by the default.
    """
    said, mode = data["reload"], data["reload"].get("replay", "")
    budget = duration(said, "budget", report, ("reload",), positive=True)
    if budget is not None and budget > MAX_BUDGET:
        hint = f"write at most {MAX_BUDGET:g}s: a saved file waits for the whole check"
        report(BAD_DURATION, ("reload", "budget"), f"{budget:g} s is too long for a check", hint=hint)
        budget = None
    if "budget" in said and not mode:
        report(IDLE_CHECK, ("reload", "budget"), "`budget` has no effect without `replay`", hint=HOW)
    if mode and not read_journal(data, report.copy()).wanted:
        where, what = ("reload", "replay"), "`replay` has no visits to play: `journal` does not keep any"
        report(IDLE_CHECK, where, what, hint="set `journal` to keep visits, or delete `replay`")
    return ReplayCheck(mode, budget or DEFAULT_BUDGET)
