"""A day on which the exhibition was killed amid a visit replays as it was, here and on another machine."""

import json
import os
import signal
import sys
from pathlib import Path
from shutil import copytree
from typing import Any

import pytest

from lumen.cli.main import main
from lumen.errors import JournalError
from lumen.insight.replay.entries import JournalJump, RecordedEntry
from lumen.journal.journal_file import read_journal
from tests.guarded import run_guarded
from tests.live.test_resuming import running, silent
from tests.waiting import HANG, until

__all__ = ["silent"]


def entries(folder: Path) -> list[RecordedEntry]:
    """Return the journal entries that are readable now; skip files that cannot be read."""
    found = list[RecordedEntry]()
    for file in sorted((folder / ".lumen" / "journal").glob("*.journal")):
        try:
            found += read_journal(file).entries
        except JournalError:
            continue
    return found


def entered(folder: Path, state: str) -> bool:
    return any(state in getattr(entry, "entered", ()) for entry in entries(folder))


def replayed(folder: Path, **environment: str) -> dict[str, Any]:
    """Return the JSON report of a replay of all days in another process."""
    command = [sys.executable, "-m", "lumen", "replay", "--all", "--project", str(folder), "--format", "json"]
    env = {**os.environ, **environment}
    done = run_guarded(command, env=env, capture_output=True, text=True, timeout=HANG)
    assert done.returncode == 0, done.stdout + done.stderr
    return dict(json.loads(done.stdout))


@pytest.mark.once
@pytest.mark.slow
@pytest.mark.usefixtures("silent")
def test_a_visit_that_was_cut_by_a_kill_replays_as_it_was(copy: Path, tmp_path_factory: pytest.TempPathFactory) -> None:
    with running(copy) as process:
        until(lambda: entered(copy, "idle") or entries(copy))
        assert main(["topic", "pub", "face", '{"x": 160, "y": 120}', "--project", str(copy)]) == 0
        until(lambda: entered(copy, "greet"))
        os.kill(process.pid, signal.SIGKILL)
        process.wait()
    assert main(["run", str(copy), "--robot", "recording", "--speed", "max", "--for", "5s"]) == 0
    kinds = [entry.kind for entry in entries(copy) if isinstance(entry, JournalJump)]
    assert "resume" in kinds
    here = replayed(copy)
    assert (here["differ"], here["unknown"], here["lost"]) == ([], [], 0)
    assert here["visits"] >= 1
    assert here["steps"] > 5
    elsewhere = copytree(copy, tmp_path_factory.mktemp("elsewhere") / "museum")
    odd = {"PYTHONHASHSEED": "7", "TZ": "Pacific/Chatham", "LC_ALL": "tr_TR.UTF-8", "LANG": "tr_TR.UTF-8"}
    assert replayed(elsewhere, **odd) == here
