"""A long journal replayed by several workers, with the same report as from one worker."""

from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import closing
from itertools import islice

from lumen.insight.replay.entries import JournalJump, RecordedEntry
from lumen.insight.replay.replaying import replay
from lumen.insight.replay.visits import RecordedVisit, visits
from lumen.journal.journal_file import header_of
from lumen.language.machines import MachineDefinition
from lumen.language.projects import Project
from lumen.run.replaying.journals import ChosenJournal, KeptBundles
from lumen.run.replaying.other_files import VisitPlayer, with_machines
from lumen.run.replaying.replay_report import ReplayCount, ReplayReport, TakenAgain
from lumen.run.workers.tasks import UnpackedKit, WorkKit, models_in
from lumen.run.workers.workers import Workers

VISITS = 20
"""The number of visits in a task."""
ENTRIES = 5_000
"""The number of entries after which a task of steps ends, at the next jump."""
NEW = "new"
"""The name of the other files among the bundles of a kit."""

Row = tuple[RecordedEntry, MachineDefinition | None]


def replay_kit(journal: ChosenJournal, bundles: KeptBundles, new: Mapping[str, bytes] | None = None) -> WorkKit:
    """Return the files that workers need for a journal: those that ran then, and other files to try."""
    hashes = {header_of(file).bundle for file in journal.files}
    kept = {hash: files for hash in hashes if (files := bundles.files(hash))}
    return WorkKit({**kept, **({NEW: new} if new else {})}, models_in(journal.root))


def shared_replay(
    entries: Iterable[RecordedEntry],
    bundles: KeptBundles,
    kit: WorkKit,
    workers: Workers,
    tell: Callable[[int], None] = lambda _: None,
) -> ReplayReport:
    """Return the same report as `replayed`; `tell` is called with the number of visits counted so far."""
    count, parts, ready = ReplayCount(), dict[int, list[Row]](), dict[int, list[TakenAgain]]()
    following = 0

    def tasks() -> Iterator[tuple[tuple[RecordedEntry, ...], bool]]:
        for number, (lead, rows) in enumerate(_parts(with_machines(entries, bundles))):
            parts[number] = rows
            yield (*lead, *(entry for entry, _ in rows)), bool(lead)

    with closing(workers.results(take_again, kit, tasks())) as results:
        for number, taken in results:
            ready[number] = taken
            while following in ready:
                for (entry, machine), again in zip(parts.pop(following), ready.pop(following), strict=True):
                    count.take(entry, machine, again)
                following += 1
            tell(count.report.visits)
    count.end()
    return count.report


def shared_against(
    entries: Iterable[RecordedEntry],
    bundles: KeptBundles,
    kit: WorkKit,
    workers: Workers,
    tell: Callable[[int], None] = lambda _: None,
) -> ReplayReport:
    """Return the report of `against` for the kit's new files; `tell` is called with the number of visits so far."""
    reports, report, played = dict[int, ReplayReport](), ReplayReport(), 0
    every = visits(with_machines(entries, bundles))
    tasks = iter(lambda: (tuple(islice(every, VISITS)),), ((),))
    with closing(workers.results(play_visits, kit, tasks)) as results:
        for number, part in results:
            reports[number] = part
            played += part.visits
            tell(played)
    for number in sorted(reports):
        report.join(reports[number])
    return report


def take_again(kit: UnpackedKit, entries: tuple[RecordedEntry, ...], led: bool) -> list[TakenAgain]:
    """Take the steps of a task again; the first entry of a `led` task only gives the snapshot and has no result."""
    taken = [TakenAgain.of(row) for row in replay(entries, _KitBundles(kit).machine)]
    return taken[1:] if led else taken


def play_visits(kit: UnpackedKit, visits: tuple[RecordedVisit, ...]) -> ReplayReport:
    """Play the visits of a task with the new files."""
    new = kit.project(NEW)
    assert new is not None  # the sender of the task has loaded it
    report, player = ReplayReport(), VisitPlayer(_KitBundles(kit), new)
    for visit in visits:
        player.play(visit, report)
    return report


class _KitBundles(KeptBundles):
    """The bundles of a journal in a worker's kit."""

    def __init__(self, kit: UnpackedKit) -> None:
        super().__init__(kit.root)
        self._kit = kit

    def load(self, hash: str) -> Project | None:
        return self._kit.project(hash)


def _parts(rows: Iterable[Row]) -> Iterator[tuple[list[RecordedEntry], list[Row]]]:
    """Yield the journal in parts, cut at jumps, which have a snapshot; a part is compared up to its last jump.

    That jump is also the lead of the next part, whose steps continue from it. A part is a list of rows, preceded by its
    lead: a list of one entry or none.
    """
    lead, part = list[RecordedEntry](), list[Row]()
    for row in rows:
        part.append(row)
        if len(part) >= ENTRIES and isinstance(row[0], JournalJump):
            yield lead, part
            lead, part = [row[0]], []
    if part:
        yield lead, part
