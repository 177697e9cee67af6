"""The result of a replay: counts of visits and steps, and the first difference of each visit."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any, NamedTuple

from lumen.insight.replay.against import SAME, VisitVerdict
from lumen.insight.replay.entries import JournalInput, JournalJump, RecordedEntry
from lumen.insight.replay.replaying import MachineSource, ReplayedStep, replay
from lumen.insight.replay.visits import RecordedVisit, VisitWatch
from lumen.language.iso_time import iso_time
from lumen.language.machines import MachineDefinition


class ReplayDifference(NamedTuple):
    """A difference between a recorded visit and its replay."""

    visit: int
    """The number of the visit; 0 outside of visits."""
    at: float
    """The time of the difference [s since 1970]."""
    was: str
    """The recorded effect."""
    now: str
    """The effect in the replay."""
    how: str = "differs"
    """`differs`, or with other files `says something else` or `ends elsewhere`."""
    place: str = ""
    """The file and line of the text said in the replay; empty if unknown."""

    def to_json(self) -> dict[str, Any]:
        """Return the difference as JSON data."""
        place = {"place": self.place} if self.place else {}
        return {"visit": self.visit, "at": iso_time(self.at), "was": self.was, "is": self.now, "how": self.how, **place}


@dataclass
class ReplayReport:
    """The counts of visits and steps in a replay, and the differences."""

    visits: int = 0
    """The number of visits."""
    steps: int = 0
    """The number of steps that were taken again."""
    same: int = 0
    """The number of visits without a difference."""
    redacted: int = 0
    """The number of visits that were not compared, because a person was forgotten."""
    lost: int = 0
    """The number of lost entries."""
    differ: list[ReplayDifference] = field(default_factory=list)
    """The first difference of each visit."""
    unknown: dict[str, int] = field(default_factory=dict)
    """The numbers of entries (with other files: of visits) that could not be compared, by the reason."""

    def to_json(self) -> dict[str, Any]:
        """Return the report as `lumen replay --format json` prints it."""
        return {
            "visits": self.visits,
            "steps": self.steps,
            "same": self.same,
            "differ": [row.to_json() for row in self.differ],
            "redacted": self.redacted,
            "lost": self.lost,
            "unknown": [{"why": why, "entries": count} for why, count in self.unknown.items()],
        }

    def add(self, verdict: VisitVerdict, visit: RecordedVisit) -> None:
        """Add the verdict on a visit that was played with other files."""
        self.steps += verdict.steps
        if verdict.how == SAME:
            self.same += 1
            return
        at = visit.ended + verdict.at - visit.inputs[-1].event.at
        place = str(verdict.place or "")
        self.differ.append(ReplayDifference(self.visits, at, verdict.was, verdict.now, verdict.how, place))

    def join(self, more: "ReplayReport") -> None:
        """Add the report on later visits that were played with other files."""
        self.differ += [row._replace(visit=row.visit + self.visits) for row in more.differ]
        self.visits += more.visits
        self.steps += more.steps
        self.same += more.same
        self.redacted += more.redacted
        for why, count in more.unknown.items():
            self.unknown[why] = self.unknown.get(why, 0) + count

    def leave_out(self, why: str) -> None:
        """Count a visit that can't be compared."""
        self.unknown[why] = self.unknown.get(why, 0) + 1


class TakenAgain(NamedTuple):
    """The result of replaying a step, small enough to be sent to another process."""

    stepped: bool
    """Whether a step was taken."""
    unknown: str = ""
    """Why the step can't be compared; empty if it can."""
    differs: bool = False
    """Whether the replayed step differs from the recorded one."""
    was: str = ""
    """The recorded step in words; empty if there is no difference."""
    now: str = ""
    """The replayed step in words; empty if there is no difference."""

    @classmethod
    def of(cls, row: ReplayedStep) -> "TakenAgain":
        """Return the result of a replayed step."""
        words = (str(row.was), str(row.now)) if row.differs else ()
        return cls(row.step is not None, row.unknown, row.differs, *words)


class ReplayCount:
    """Counts replayed steps, and the visits and differences among them; `report` is the result."""

    def __init__(self) -> None:
        self.report = ReplayReport()
        self._watch, self._inside, self._differs, self._redacted = VisitWatch(), False, False, False
        self._outside = False

    def take(self, entry: RecordedEntry, machine: MachineDefinition | None, row: TakenAgain) -> None:
        """Count the next step, with the machine that ran then."""
        report = self.report
        part = self._watch.take(entry, machine)
        begins = isinstance(entry, JournalJump) and entry.kind == "start"
        if self._inside and (not part or begins):
            self.end()
        if part and not self._inside:
            report.visits += 1
            self._inside, self._differs, self._redacted = True, False, False
        report.steps += row.stepped
        self._redacted |= entry.redacted
        if isinstance(entry, JournalJump):
            report.lost += int(entry.said.get("lost", 0))
        if row.unknown and not entry.redacted:
            report.unknown[row.unknown] = report.unknown.get(row.unknown, 0) + 1
        if row.differs and not (self._differs if self._inside else self._outside):
            self._tell(entry, row)
        if self._inside and not self._watch.away:
            self.end()

    def end(self) -> None:
        """Finish the current visit, if there is one."""
        if self._inside:
            self._inside = False
            self.report.redacted += self._redacted
            self.report.same += not self._redacted and not self._differs

    def _tell(self, entry: RecordedEntry, row: TakenAgain) -> None:
        at = self._watch.at
        number = self.report.visits if self._inside else 0
        what = entry.event.name if isinstance(entry, JournalInput) else entry.kind
        self.report.differ.append(ReplayDifference(number, at, f"{what}: {row.was}", f"{what}: {row.now}"))
        if self._inside:
            self._differs = True
        else:
            self._outside = True


def replayed(entries: Iterable[RecordedEntry], machines: MachineSource) -> ReplayReport:
    """Return the result of taking all steps again with the files that ran then."""
    count = ReplayCount()
    for row in replay(entries, machines):
        count.take(row.entry, row.machine, TakenAgain.of(row))
    count.end()
    return count.report
