"""An exhibition that ended without notice resumes from its last state, even if its files are newer."""

import json
import os
import signal
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

import lumen
from lumen.cli.main import main
from lumen.language.commands import Track
from lumen.project.files import read_files
from lumen.project.home import ADDRESS_FILE, Home, home_of
from lumen.run.recovery.previous_run import LATELY
from lumen.run.recovery.run_directory import RunDirectory
from lumen.run.reload_journal import MAX_JOURNAL_BYTES, Journal
from lumen.run.resuming import LOST_COMMAND_REASON, FreshStart, Resumption, resume
from lumen.run.snapshot_store import ALIVE_FILE, SNAPSHOT_FILE, SnapshotStore
from lumen.statechart import serialize
from tests.guarded import PIPE, Guarded
from tests.live.shows import Live
from tests.waiting import until

pytestmark = pytest.mark.rest  # expensive

SORRY, PARDON = 'en: "I am sorry, I did not understand that."', 'en: "Come again, please?"'


def crashed(live: Live) -> None:
    """Let the show greet Ada and be asked to dance; then end it without notice."""
    assert live.records.keeper
    live.records.store(read_files(live.folder))
    live.greet()
    live.speak("my name is Ada", "how_are_you")
    live.speak("fine", "offer")
    live.speak("dance", "dance")
    live.live(4.0)
    live.records.keep(live.show.loop)
    live.close()


def resumed(folder: Path) -> Resumption | FreshStart:
    run_directory = RunDirectory(folder)
    found = run_directory.resumption(lumen.load(folder))
    run_directory.close(forget=False)
    return found


@pytest.mark.slow
def test_it_goes_on_where_it_was_and_what_was_under_way_as_the_state_says(copy: Path) -> None:
    one = Live(copy)
    crashed(one)
    found = resumed(copy)
    assert isinstance(found, Resumption)
    assert "dance" in found.snapshot.configuration
    assert found.snapshot.context["visitor"] == "Ada"
    assert found.tracking == ("head",)
    assert {event.data["reason"] for event in found.answers(0.0)} == {LOST_COMMAND_REASON}
    again = Live(copy)
    again.show.loop.resume(found)
    again.until_told("offer, face.watched.armed  (done, then visitor.asked)")  # of a dance that is resumed never
    assert "offer" in again.states
    assert again.show.loop.tracking.on == ("head",)
    again.show.close()


@pytest.mark.slow
@pytest.mark.usefixtures("silent")
@pytest.mark.parametrize("words", [[], ["--fresh"]])
def test_a_robot_that_was_stopped_long_ago_waits_for_a_person(
    words: list[str], copy: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    live = Live(copy)
    assert live.records.keeper
    live.records.store(read_files(live.folder))
    live.show.loop.happen(lumen.Event("stop", {}))
    live.live(1.0)
    assert "stopped" in live.states
    live.records.keep(live.show.loop)
    live.close()
    home = Home(home_of(copy))
    data = json.loads(home.read(SNAPSHOT_FILE) or b"")
    home.write(SNAPSHOT_FILE, json.dumps({**data, "time": time.time() - 50 * LATELY}).encode())
    home.remove(ALIVE_FILE)
    assert main(["run", str(copy), "--robot", "recording", "--speed", "max", "--for", "3min", *words]) == 0
    told = capsys.readouterr().out
    assert "or run `lumen resume`" in told
    assert "stopped, paused  (stop" in told
    assert "watching  (" not in told


@pytest.mark.slow
def test_newer_files_are_a_reload(copy: Path) -> None:
    one = Live(copy)
    crashed(one)
    one.edit(SORRY, PARDON)
    found = resumed(copy)
    assert isinstance(found, Resumption)
    assert found.snapshot.context["visitor"] == "Ada"


def test_timers_go_on_while_nobody_is_there(copy: Path) -> None:
    one = Live(copy)
    one.greet()
    project, snapshot = one.show.loop.project, one.show.loop.runtime.snapshot
    one.close()
    [timer] = [t for t in snapshot.timers if t.delay == 7200.0]
    found = resume(project, project, snapshot, 20.0, ())
    assert isinstance(found, Resumption)
    [later] = [t for t in found.snapshot.timers if t.delay == 7200.0]
    assert later.due == pytest.approx(timer.due - snapshot.at - 20.0)


@pytest.mark.slow
def test_what_is_too_old_or_damaged_is_begun_anew(copy: Path) -> None:
    one = Live(copy)
    crashed(one)
    home = Home(home_of(copy))
    data = json.loads(home.read(SNAPSHOT_FILE) or b"")
    home.write(SNAPSHOT_FILE, json.dumps({**data, "time": time.time() - LATELY - 60.0}).encode())
    home.remove(ALIVE_FILE)
    assert "starts from the beginning" in str(resumed(copy))
    alive = time.time() - 1.0
    home.write(ALIVE_FILE, json.dumps({"time": alive}).encode())  # nothing happened before the crash
    assert isinstance(found := resumed(copy), Resumption)
    assert 1.0 <= found.away <= time.time() - alive
    home.write(SNAPSHOT_FILE, json.dumps({**data, "bundle": "0" * 64}).encode())
    assert "its files were not kept" in str(resumed(copy))


@pytest.mark.slow
def test_what_another_lumen_has_left_is_told_and_begun_anew(copy: Path) -> None:
    one = Live(copy)
    crashed(one)
    home = Home(home_of(copy))
    data = json.loads(home.read(SNAPSHOT_FILE) or b"")
    home.write(SNAPSHOT_FILE, json.dumps({**data, "version": 7, "rests": True}).encode())
    found = resumed(copy)
    assert isinstance(found, FreshStart)
    assert found.rests
    assert "its snapshot has version 7, this one reads 1" in found.why
    assert "start it with the same version of Lumen" in found.why
    files = {**read_files(copy), "lumen.yaml": b"lumen: 9\n" + (copy / "lumen.yaml").read_bytes()}
    bundle = SnapshotStore(home).store(files)
    home.write(SNAPSHOT_FILE, json.dumps({**data, "bundle": bundle}).encode())
    assert "this project is written for vocabulary 9" in str(resumed(copy))
    home.write(SNAPSHOT_FILE, json.dumps({**data, "snapshot": {"version": 1}}).encode())
    assert "can't be continued" in str(resumed(copy))
    for damaged in (b"", b"{", b"[]", b'{"version": 1}', b"\xff"):
        home.write(SNAPSHOT_FILE, damaged)
        assert resumed(copy) == FreshStart()


def test_a_bundle_that_was_changed_is_not_taken(copy: Path) -> None:
    home = Home(home_of(copy))
    assert home.hold()
    keeper = SnapshotStore(home)
    hash = keeper.store(read_files(copy))
    assert keeper.files(hash) == read_files(copy)
    [packed] = home.folder.glob("bundle-*.zip")
    packed.write_bytes(packed.read_bytes()[:-200])
    assert keeper.files(hash) is None
    keeper.prune()
    assert not list(home.folder.glob("bundle-*.zip"))
    home.release()


def test_only_what_is_new_is_written(copy: Path) -> None:
    one = Live(copy)
    keeper, show = one.records.keeper, one.show.loop
    assert keeper
    one.records.keep(show)
    one.records.keep(show)
    one.records.close()
    assert keeper.count == 1
    kept = keeper.kept()
    assert kept
    assert kept.frozen == serialize(show.project.machine, show.runtime.snapshot)
    show.tracking.switch(Track("head"))
    one.close()


@pytest.mark.slow
def test_a_disk_that_refuses_ends_nothing(copy: Path, caplog: pytest.LogCaptureFixture) -> None:
    one = Live(copy)
    (one.home.folder / f"{SNAPSHOT_FILE}.new").mkdir()
    one.greet()
    one.records.keep(one.show.loop)
    one.close()
    assert "can't be kept" in caplog.text


@pytest.mark.slow
def test_the_journal_is_bounded_and_whole(tmp_path: Path) -> None:
    journal = Journal(tmp_path)
    for number in range(3_000):
        journal.write({"number": number, "text": "x" * 1_000})
    sizes = [file.stat().st_size for file in tmp_path.iterdir()]
    assert len(sizes) == 2
    assert sum(sizes) < 2.2 * MAX_JOURNAL_BYTES
    numbers = [entry["number"] for entry in journal.entries()]
    assert numbers == list(range(numbers[0], 3_000))
    with (tmp_path / "journal.jsonl").open("a") as file:
        file.write('{"number": 3000, "te')
    assert [entry["number"] for entry in journal.entries()] == numbers


@contextmanager
def running(folder: Path, *words: str) -> Iterator[Guarded[str]]:
    """Run `lumen run` with an open standard input; yield it once it can be reached."""
    run = [sys.executable, "-m", "lumen", "run", str(folder), "--robot", "recording", "--speed", "4", *words]
    with Guarded(run, stdin=PIPE, stdout=PIPE, text=True) as process:
        try:
            until(lambda: (home_of(folder) / ADDRESS_FILE).exists() and Home(home_of(folder)).held())
            yield process
        finally:
            process.kill()


@pytest.fixture
def silent(monkeypatch: pytest.MonkeyPatch) -> None:
    """Remove standard input, so no text is typed."""
    monkeypatch.setattr(sys, "stdin", None)


@pytest.mark.slow
@pytest.mark.usefixtures("silent")
def test_a_run_that_is_killed_is_gone_on_with(copy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with running(copy) as process:
        until(lambda: (home_of(copy) / SNAPSHOT_FILE).exists())
        until(lambda: main(["say", "Hello", str(copy)]) == 0)  # a slow machine may not answer in time
        until(lambda: main(["reload", str(copy), "--status"]) == 0)
        until(lambda: main(["reload", str(copy)]) == 0)
        os.kill(process.pid, signal.SIGKILL)
        process.wait()
    assert "said" in capsys.readouterr().out
    assert main(["reload", str(copy)]) == 2
    assert "no exhibition of" in capsys.readouterr().err
    run = ["run", str(copy), "--robot", "recording", "--speed", "max", "--for", "1s"]
    assert main(run) == 0
    assert "The last run ended unexpectedly" in capsys.readouterr().out
    assert main(run) == 0
    assert "ended unexpectedly" not in capsys.readouterr().out
    tour = copy / "behaviors" / "tour.yaml"
    tour.write_text(tour.read_text("utf-8") + "broken: [", "utf-8")
    assert main(run) == 1
    assert "lumen run --last-good" in capsys.readouterr().err
    assert main([*run, "--last-good"]) == 0
    assert "THE FILES HAVE ERRORS" in capsys.readouterr().err


@pytest.mark.slow
@pytest.mark.usefixtures("silent")
def test_a_second_run_of_a_project_leaves_the_first_alone(copy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with running(copy):
        assert main(["run", str(copy), "--robot", "recording", "--speed", "max", "--for", "1s", "--fresh"]) == 0
        assert "This project is already running in another process" in capsys.readouterr().out
        assert main(["stop", str(copy)]) == 0
