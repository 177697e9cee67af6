"""A reload is in the journal, too: the same events and the same bundles, in their order, give the same steps."""

from pathlib import Path

import pytest

from lumen.app.recovery.recording import record_inputs
from lumen.interpreters.replay.entries import JournalJump
from lumen.interpreters.replay.replaying import replay
from lumen.language.machines import MachineDefinition
from lumen.loading.files import read_files
from lumen.rules import check_files
from lumen.runtime.inputs.journal_file import read_journal
from lumen.runtime.inputs.journal_folder import JOURNAL_FOLDER, JournalFolder
from tests.live.shows import Live

FINE = "en: [I am glad to hear that.,"


@pytest.mark.slow
def test_a_run_replays_across_reloads_to_the_same_steps(copy: Path) -> None:
    live = Live(copy)
    loop, keeper = live.show.loop, live.records.keeper
    assert keeper
    keeper.store(read_files(copy))
    record_inputs(live.show.behavior, live.records, story=None, rehearsed=False)
    assert live.records.inputs
    live.records.inputs.jumped("keyframe", loop.project, loop.runtime.snapshot)  # the show has begun already
    live.greet()
    live.edit(FINE, "en: [How wonderful.,")
    live.until_told("are active")
    live.speak("my name is Ada", "how_are_you")
    live.edit("en: Never mind.", "en: No problem.")
    live.until(lambda: live.verdicts.count("applied") == 2)
    live.speak("fine", "offer")
    live.show.close()
    files = JournalFolder(live.home.folder / JOURNAL_FOLDER, 30.0, 100.0).files()
    entries = [entry for file in files for entry in read_journal(file).entries]
    machines = dict[str, MachineDefinition]()

    def machine(hash: str, behavior: str) -> MachineDefinition:
        if hash not in machines:
            found = keeper.files(hash)
            assert found
            project = check_files(live.folder, found)[0]
            assert project
            machines[hash] = project.behaviors[behavior]
        return machines[hash]

    again = list(replay(entries, machine))
    assert [(row.was, row.now, row.unknown) for row in again if row.differs or row.unknown] == []
    journaled = [entry["after"] for entry in live.records.journal.entries() if entry["verdict"] == "applied"]
    reloads = [entry.bundle for entry in entries if isinstance(entry, JournalJump) and entry.kind == "reload"]
    assert reloads == journaled
    assert again[-1].after == loop.runtime.snapshot
