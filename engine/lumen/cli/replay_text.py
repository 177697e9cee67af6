"""The result of a replay, as text for people."""

from collections.abc import Iterator

from lumen.language.counts import counted
from lumen.language.iso_time import local_time
from lumen.run.replaying.replay_report import ReplayReport

SHOWN = 10
"""The maximum number of differences that are listed."""


def replay_lines(report: ReplayReport, *, other: bool) -> Iterator[str]:
    """Yield the lines of a report: the counts, the first differences, and the entries that could not be compared.

    `other` is true if the replay used files other than those of the recorded visits.
    """
    counts = [f"{report.same} the same"]
    for how in ("differs", "says something else", "ends elsewhere"):
        count = sum(row.how == how and row.visit > 0 for row in report.differ)
        if count:
            counts.append(f"{count} {_plural(how, count)}")
    if report.redacted:
        counts.append(f"{report.redacted} redacted, because a visitor was forgotten")
    yield f"{report.visits} visit{'s' * (report.visits != 1)}, {report.steps:,} steps: {', '.join(counts)}"
    for row in report.differ[:SHOWN]:
        when = local_time(row.at)
        yield f"  {f'visit {row.visit}' if row.visit else 'between visits'}, {when}: {row.how}"
        yield f"    was  {row.was}"
        yield f"    {'here' if other else 'now '} {row.now}" + (f" ({row.place})" if row.place else "")
    if len(report.differ) > SHOWN:
        yield f"  and {len(report.differ) - SHOWN} more"
    if report.lost:
        lost = counted(report.lost, "entry", "entries")
        yield f"  missing from the journal: {lost}, because the disk was full or too slow"
    for why, count in report.unknown.items():
        yield f"  not compared: {count:,} {why if other else f'entries: {why}'}"


def _plural(how: str, count: int) -> str:
    if count == 1:
        return how
    return {"differs": "differ", "says something else": "say something else", "ends elsewhere": "end elsewhere"}[how]
