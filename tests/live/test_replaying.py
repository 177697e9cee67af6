"""A reload is in the journal, too: the same events and the same bundles, in their order, give the same steps."""

from pathlib import Path

import pytest

from lumen.insight.replay.entries import JournalJump, RecordedEntry
from lumen.insight.replay.replaying import ReplayedStep, replay
from lumen.journal.journal_file import read_journal
from lumen.journal.journal_folder import JOURNAL_FOLDER, JournalFolder
from lumen.language.machines import MachineDefinition
from lumen.lint import check_files
from lumen.project.files import read_files
from lumen.run.recovery.journaling import record_inputs
from lumen.run.snapshot_store import SnapshotStore
from tests.live.shows import Live

FINE = "en: [I am glad to hear that.,"


def journaled(live: Live) -> SnapshotStore:
    """Record the inputs from now on, in the store that keeps the files; return the store."""
    loop, keeper = live.show.loop, live.records.keeper
    assert keeper
    keeper.store(read_files(live.folder))
    record_inputs(live.show.behavior, live.records, story=None, rehearsed=False)
    assert live.records.inputs
    live.records.inputs.jumped("keyframe", loop.project, loop.runtime.snapshot)  # the show has begun already
    return keeper


def entries_of(live: Live) -> list[RecordedEntry]:
    files = JournalFolder(live.home.folder / JOURNAL_FOLDER, 30.0, 100.0).files()
    return [entry for file in files for entry in read_journal(file).entries]


def again(live: Live, keeper: SnapshotStore) -> list[ReplayedStep]:
    """Return the replay of the journal of a show that is over, with the files that were kept."""
    machines = dict[str, MachineDefinition]()

    def machine(hash: str, behavior: str) -> MachineDefinition:
        if hash not in machines:
            found = keeper.files(hash)
            assert found
            project = check_files(live.folder, found)[0]
            assert project
            machines[hash] = project.behaviors[behavior]
        return machines[hash]

    return list(replay(entries_of(live), machine))


@pytest.mark.slow
def test_a_run_replays_across_reloads_to_the_same_steps(copy: Path) -> None:
    live = Live(copy)
    keeper = journaled(live)
    live.greet()
    live.edit(FINE, "en: [How wonderful.,")
    live.until_told("are active")
    live.speak("my name is Ada", "how_are_you")
    live.edit("en: Never mind.", "en: No problem.")
    live.until(lambda: live.verdicts.count("applied") == 2)
    live.speak("fine", "offer")
    live.close()
    rows = again(live, keeper)
    assert [(row.was, row.now, row.unknown) for row in rows if row.differs or row.unknown] == []
    journaled_hashes = [entry["after"] for entry in live.records.journal.entries() if entry["verdict"] == "applied"]
    jumps = [entry for entry in entries_of(live) if isinstance(entry, JournalJump)]
    assert [entry.bundle for entry in jumps if entry.kind == "reload"] == journaled_hashes
    assert rows[-1].after == live.show.loop.runtime.snapshot


@pytest.mark.slow
def test_a_day_with_files_that_were_taken_back_replays_to_its_end(copy: Path) -> None:
    live = Live(copy)
    keeper, before = journaled(live), live.show.loop.project.hash
    live.greet()
    live.edit(FINE, "en: [How wonderful.,")
    live.until_told("are active")
    live.speak("my name is Ada", "how_are_you")
    assert live.ask("rollback")["verdict"] == "applied"
    assert live.show.loop.project.hash == before
    live.speak("fine", "offer")
    live.speak("dance", "dance")
    live.live(3.0)
    live.close()
    rows = again(live, keeper)
    assert [(row.was, row.now, row.unknown) for row in rows if row.differs or row.unknown] == []
    jumps = [entry for entry in entries_of(live) if isinstance(entry, JournalJump) and entry.kind != "keyframe"]
    assert len(jumps) == 2
    assert jumps[0].bundle != before == jumps[1].bundle
    assert sum(row.step is not None for row in rows) > 20
    assert rows[-1].after == live.show.loop.runtime.snapshot
