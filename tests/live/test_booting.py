"""The files that a start uses, the message about this choice, and its entry in the journal."""

import sys
from pathlib import Path
from typing import Any

import pytest

import lumen
from lumen.cli.main import main
from lumen.errors import BusError
from lumen.project.crash_counter import MAX_CRASHES, MAX_KNOWN_BUNDLES, CrashCounter
from lumen.project.files import read_files
from lumen.project.home import Home, home_of
from lumen.run.node import Node
from lumen.run.recovery.run_directory import RunDirectory
from lumen.run.recovery.startup import startup_project
from lumen.run.reload_journal import Journal
from tests.live.shows import Live

pytestmark = pytest.mark.rest  # expensive

TOUR = "behaviors/tour.yaml"
SORRY, PARDON = 'en: "I am sorry, I did not understand that."', 'en: "Come again, please?"'


def save(folder: Path, old: str, new: str) -> None:
    text = (folder / TOUR).read_text("utf-8")
    assert old in text
    (folder / TOUR).write_text(text.replace(old, new), "utf-8")


def journal(folder: Path) -> list[dict[str, Any]]:
    return list(Journal(home_of(folder)).entries())


@pytest.fixture
def run(copy: Path, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """The arguments that run the copy for one second, without typed input."""
    monkeypatch.setattr(sys, "stdin", None)
    return ["run", str(copy), "--robot", "recording", "--speed", "max", "--for", "1s"]


def fail_with(monkeypatch: pytest.MonkeyPatch, hash: str, error: Exception) -> None:
    """From now on, let each tick on the files with this hash raise `error`."""
    usual = Node.tick

    def tick(node: Node) -> float:
        if node.project.hash == hash:
            raise error
        return usual(node)

    monkeypatch.setattr(Node, "tick", tick)


@pytest.mark.slow
def test_files_that_end_every_start_give_way_to_the_last_good_ones(
    copy: Path, run: list[str], monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(run) == 0
    good = lumen.load(copy).hash
    save(copy, SORRY, PARDON)
    bad = lumen.load(copy).hash
    fail_with(monkeypatch, bad, ZeroDivisionError("a fault of ours"))
    for _ in range(MAX_CRASHES):
        with pytest.raises(ZeroDivisionError):
            main(run)
    capsys.readouterr()
    for _ in range(MAX_CRASHES + 1):
        assert main(run) == 0
        told = capsys.readouterr()
        assert "THE EXHIBITION ENDED 2 TIMES" in told.err
        assert "refused: the exhibition ended 2 times" in told.out.replace("\n" + " " * 18, " ")
        entry = journal(copy)[-1]
        assert (entry["verdict"], entry["who"], entry["before"], entry["after"]) == ("refused", "start", good, bad)
    save(copy, PARDON, "en: What was that?")
    assert main(run) == 0
    assert "THESE FILES" not in capsys.readouterr().err


@pytest.mark.slow
def test_what_a_start_has_left_aside_is_taken_once_it_changes(copy: Path) -> None:
    before = lumen.load(copy)
    save(copy, SORRY, PARDON)
    one = Live(copy, project=before, seen=lumen.load(copy).hash)
    one.live(40.0)
    assert one.show.loop.project is before
    assert one.verdicts == []
    save(copy, PARDON, "en: What was that?")
    one.until_told("are active")
    one.close()


@pytest.mark.slow
def test_a_fault_of_the_world_is_no_fault_of_the_files(
    copy: Path, run: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    hash = lumen.load(copy).hash
    fail_with(monkeypatch, hash, BusError("the broker is gone"))
    for _ in range(MAX_CRASHES):
        assert main(run) == 2
    assert CrashCounter(Home(home_of(copy))).count(hash) == 0


@pytest.mark.slow
def test_bad_files_and_last_good_are_journaled(copy: Path, run: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(run) == 0
    save(copy, 'done.do.*: "#any_question"', 'done.do.*: "#any_questoin"')
    assert main([*run, "--last-good"]) == 0
    told = capsys.readouterr()
    assert "THE FILES HAVE ERRORS: IT STARTS WITH THE LAST GOOD ONES" in told.err
    assert "did you mean `#any_question`?" in told.out
    [entry] = journal(copy)
    assert (entry["verdict"], entry["who"]) == ("refused", "start")
    assert entry["diagnostics"][0]["code"] == "unknown-state"


@pytest.mark.slow
def test_a_start_on_newer_files_is_a_reload_and_journaled(copy: Path, run: list[str]) -> None:
    one = Live(copy)
    before = one.show.loop.project.hash
    one.records.store(read_files(copy))
    one.greet()
    one.records.keep(one.show.loop)
    one.close()
    save(copy, SORRY, PARDON)
    assert main(run) == 0
    [entry] = journal(copy)
    assert (entry["verdict"], entry["who"]) == ("applied", "start")
    assert (entry["before"], entry["after"]) == (before, lumen.load(copy).hash)
    assert entry["changes"]
    assert entry["took"]


def test_how_often_files_did_not_last_is_remembered_of_the_latest(tmp_path: Path) -> None:
    home = Home(tmp_path)
    trials = CrashCounter(home)
    for number in range(2 * MAX_KNOWN_BUNDLES):
        trials.begin(f"bundle {number}")
    assert [
        trials.count(f"bundle {number}")
        for number in (0, MAX_KNOWN_BUNDLES - 1, MAX_KNOWN_BUNDLES, 2 * MAX_KNOWN_BUNDLES - 1)
    ] == [0, 0, 1, 1]
    trials.begin("bundle 39")
    trials.annul("bundle 39")
    assert trials.count("bundle 39") == 1
    trials.acquit("bundle 39")
    assert trials.count("bundle 39") == 0
    for damaged in (b"", b"[]", b"{", b'{"bundles": 7}', b'{"bundles": {"a": "b"}}'):
        home.write("trials.json", damaged)
        assert trials.count("bundle 30") == 0


def test_where_nothing_else_is_known_to_be_good_the_files_are_tried_again(copy: Path) -> None:
    run_directory = RunDirectory(copy)
    first = startup_project(copy, run_directory, last_good=False)
    for _ in range(MAX_CRASHES):
        run_directory.records.begin(first.hash)
    assert startup_project(copy, run_directory, last_good=False).hash == first.hash
    assert run_directory.news == []
    run_directory.close(forget=False)


@pytest.mark.slow
def test_what_was_replaced_has_ended_nothing_and_what_failed_has(live: Live) -> None:
    trials, exhibition = live.records.trials, live.show.loop
    assert trials
    live.edit(SORRY, PARDON)
    live.until_told("are active")
    first = exhibition.project.hash
    assert trials.count(first) == 1
    live.edit(PARDON, "en: What was that?")
    live.until(lambda: live.verdicts.count("applied") == 2)
    second = exhibition.project.hash
    assert (trials.count(first), trials.count(second)) == (0, 1)
    assert exhibition._rescued(ZeroDivisionError("a fault of ours")) is not None
    assert live.verdicts[-1] == "rolled back"
    live.live(11.0)
    assert trials.count(second) == 1


def test_what_is_asked_in_vain_is_journaled(live: Live) -> None:
    assert live.ask("rollback")["verdict"] == "refused"
    [entry] = live.records.journal.entries()
    assert (entry["verdict"], entry["who"]) == ("refused", "command")
    assert "nothing to go back to" in entry["reason"]
