"""The check of saved files against recorded visits: what would visitors have noticed?"""

import time
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from lumen.language.iso_time import local_time
from lumen.language.projects import Project
from lumen.language.replay_check import CheckMode
from lumen.run.replaying.replay_report import ReplayReport

MAX_LISTED = 10
"""The number of differences that are listed."""


class BudgetSpentError(Exception):
    """The time budget is used up."""


@dataclass(frozen=True)
class VisitsCheck:
    """The result of playing recorded visits with saved files, the newest first."""

    report: ReplayReport = field(default_factory=ReplayReport)
    """Counts and differences."""
    mode: CheckMode = "warn"
    """Whether differences are only reported (`warn`), or refuse the files (`refuse`)."""
    budget: float = 0.0
    """The time for the check [s]."""
    complete: bool = True
    """Whether all visits were played within `budget`."""
    trouble: str = ""
    """Why the check failed; empty if it succeeded."""

    @property
    def objects(self) -> bool:
        """Whether the files must be refused because of a difference."""
        return self.mode == "refuse" and bool(self.report.differ)

    def lines(self) -> Iterator[str]:
        """Yield the lines for people; none if no visit is recorded."""
        report = self.report
        if self.trouble:
            yield f"the recorded visits were not played with these files: {self.trouble}"
        elif report.visits:
            yield f"of {self._which()}: {self._counts()}"
        elif not self.complete:
            yield f"no recorded visit could be played within {self.budget:g} s (`budget` in lumen.yaml)"
        if report.differ:
            first = report.differ[0]
            when = local_time(first.at)
            place = f" ({first.place})" if first.place else ""
            was = f"was {first.was}, would be " if first.was else ""
            yield f"the first, {when}: {was}{first.now}{place}"

    def _which(self) -> str:
        count = self.report.visits
        visits = f"{count:,} visit{'s' * (count != 1)}"
        return visits if self.complete else f"the last {visits} (there was no time for more in {self.budget:g} s)"

    def _counts(self) -> str:
        report = self.report
        rows = [(report.same, "the same", "the same")]
        for how, many in (("says something else", "say something else"), ("ends elsewhere", "end elsewhere")):
            rows.append((sum(row.how == how for row in report.differ), how, many))
        rows.append((report.redacted, "redacted", "redacted"))
        rows.append((sum(report.unknown.values()), "not compared", "not compared"))
        told = [f"{count:,} {one if count == 1 else many}" for count, one, many in rows if count]
        return ", ".join(told)

    def to_json(self) -> dict[str, Any]:
        """Return the result as JSON data, with the first MAX_LISTED differences."""
        said = self.report.to_json() | {"differ": [row.to_json() for row in self.report.differ[:MAX_LISTED]]}
        more = {"mode": self.mode, "complete": self.complete, "differing": len(self.report.differ)}
        return said | more | ({"trouble": self.trouble} if self.trouble else {})


def check_visits(root: Path, new: Project, running: str, budget: float) -> VisitsCheck:
    """Play the recorded visits of the project in `root` with the files of `new`; return the result.

    Visits are played for at most `budget` [s]. Differences that the files of the bundle `running` also cause do not
    count.
    """
    from lumen.journal.journal_folder import JOURNAL_FOLDER, JournalFolder
    from lumen.project.home import home_of
    from lumen.run.replaying.journals import KeptBundles  # needed only to play visits
    from lumen.run.replaying.latest_visits import latest_first
    from lumen.run.replaying.other_files import VisitPlayer

    until = time.monotonic() + budget

    def hurry() -> None:
        if time.monotonic() > until:
            raise BudgetSpentError

    report, bundles = ReplayReport(), KeptBundles(root, new.one_of_several)
    player = VisitPlayer(bundles, new, running=running, hurry=hurry)
    files = JournalFolder(home_of(root, new.one_of_several) / JOURNAL_FOLDER, 0.0, 0.0).files()
    try:
        for visit in latest_first(files, bundles):
            hurry()
            player.play(visit, report)
    except BudgetSpentError:
        return VisitsCheck(report, budget=budget, complete=False)
    return VisitsCheck(report, budget=budget)
