"""Saved files are tried on recorded visits: `warn` reports differences, `refuse` refuses, a person may overrule."""

import sys
from pathlib import Path
from types import SimpleNamespace

import pytest

import lumen
from lumen.insight.replay.entries import JournalInput, JournalJump
from lumen.insight.replay.replaying import replay
from lumen.journal.journal_file import FramePacker, line_of, read_journal
from lumen.journal.journal_folder import JOURNAL_FOLDER, REHEARSED_FOLDER
from lumen.journal.redaction import redact
from lumen.language.people import PersonName
from lumen.project.home import home_of
from lumen.run.reload import validation_worker, visits_check
from lumen.run.reload.visits_check import VisitsCheck, check_visits
from lumen.run.replaying.journals import KeptBundles
from lumen.run.replaying.latest_visits import latest_first
from lumen.statechart import serialize
from tests import ROOT
from tests.copying import copied_project
from tests.live.shows import Live

pytestmark = pytest.mark.rest  # expensive

HELLO = "behaviors/hello.yaml"
VISITS = 3


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A small exhibition that keeps some visits."""
    folder = copied_project(ROOT / "examples" / "minimal", tmp_path / "minimal")
    (story,) = lumen.load(folder).stories
    for _ in range(VISITS):
        with lumen.open(folder, story=story) as exhibition:
            exhibition.run()
    journal = home_of(folder) / JOURNAL_FOLDER
    for file in (journal / REHEARSED_FOLDER).glob("*.journal"):
        file.rename(journal / file.name)
    return folder


def say(folder: Path, old: str, new: str, file: str = HELLO) -> None:
    text = (folder / file).read_text("utf-8")
    assert old in text
    (folder / file).write_text(text.replace(old, new), "utf-8")


def check(folder: Path, budget: float = 300.0, running: str = "") -> VisitsCheck:
    return check_visits(folder, lumen.load(folder), running, budget)


def journal(folder: Path) -> list[Path]:
    return sorted((home_of(folder) / JOURNAL_FOLDER).glob("*.journal"))


def test_what_would_be_said_otherwise_has_its_place(folder: Path) -> None:
    found = check(folder)
    assert list(found.lines()) == ["of 3 visits: 3 the same"]
    say(folder, "en: Goodbye!", "en: So long!")
    found = check(folder)
    assert (found.report.visits, found.report.same, len(found.report.differ), found.complete) == (3, 0, 3, True)
    first, second = found.lines()
    assert first == "of 3 visits: 3 say something else"
    assert second.endswith("was “Goodbye!” (en), would be “So long!” (en) (behaviors/hello.yaml:12:24)")
    say(folder, "    onDone: waiting\n", "")
    assert next(iter(check(folder).lines())) == "of 3 visits: 3 end elsewhere"


def test_what_the_running_files_have_changed_is_not_news(folder: Path) -> None:
    say(folder, "en: Goodbye!", "en: So long!")
    changed = lumen.load(folder)
    with lumen.open(folder, story="visitor") as exhibition:
        exhibition.run()  # keeps the files that run
    found = check(folder, running=changed.hash)
    assert (found.report.same, found.report.differ) == (VISITS, [])
    say(folder, "Good to see you!", "Nice to see you!")
    say(folder, "Hello! I am Nao.", "Ahoy! I am Nao.")
    found = check(folder, running=changed.hash)
    assert len(found.report.differ) == VISITS
    assert all("So long" not in row.was + row.now for row in found.report.differ)


def test_the_newest_visits_come_first_and_the_rest_is_said_to_be_missing(
    folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    first = [visit.first for visit in latest_first(journal(folder), KeptBundles(folder))]
    assert len(first) == VISITS
    assert first == sorted(first, reverse=True)
    found = check(folder, budget=0.0)
    assert (found.report.visits, found.complete) == (0, False)
    assert list(found.lines()) == ["no recorded visit could be played within 0 s (`budget` in lumen.yaml)"]
    asked = [0.0]

    def clock() -> float:
        asked[0] += 1.0
        return asked[0]

    monkeypatch.setattr(visits_check, "time", SimpleNamespace(monotonic=clock))
    assert check(folder, budget=1e6).complete
    budget, asked[0] = asked[0] - 3.0, 0.0  # it ends within the last one
    found = check(folder, budget=budget)
    assert found.report.visits == VISITS - 1
    assert not found.complete
    told = f"of the last 2 visits (there was no time for more in {budget:g} s): 2 the same"
    assert list(found.lines()) == [told]


def test_a_visit_that_goes_on_in_the_next_file_is_one_visit(folder: Path) -> None:
    bundles = KeptBundles(folder)
    before = list(latest_first(journal(folder), bundles))
    file = journal(folder)[-1]
    content = read_journal(file)
    cut = next(i for i, entry in enumerate(content.entries) if isinstance(entry, JournalInput) and entry.entered) + 1
    row = list(replay(content.entries[:cut], bundles.machine))[-1]
    assert row.machine
    assert row.after
    start = next(entry for entry in content.entries if isinstance(entry, JournalJump))
    stands = JournalJump(0, "keyframe", row.after.at, start.bundle, start.behavior, serialize(row.machine, row.after))
    second = content.header._replace(first=content.header.first + cut)
    parts = ((content.header, content.entries[:cut]), (second, (stands, *content.entries[cut:])))
    for number, (header, entries) in enumerate(parts):
        path = file.with_name(f"{header.first:012d}-part{number}.journal")
        path.write_bytes(header.line() + FramePacker().pack(b"".join(map(line_of, entries))))
    file.unlink()
    after = list(latest_first(journal(folder), bundles))
    assert [visit.whole for visit in after] == [visit.whole for visit in before]
    assert len(after) == len(before) == VISITS
    assert check(folder).report.same == VISITS


def test_no_journal_and_visits_of_who_is_forgotten(folder: Path) -> None:
    for file in journal(folder):
        redact(file, PersonName("Goodbye", ()))
    found = check(folder)
    assert (found.report.redacted, found.report.differ) == (VISITS, [])
    assert list(found.lines()) == ["of 3 visits: 3 redacted"]
    for file in journal(folder):
        file.write_bytes(b"nothing that is a journal")
    assert list(check(folder).lines()) == []
    for file in journal(folder):
        file.unlink()
    assert list(check(folder).lines()) == []


def begin(folder: Path, mode: str, *, apart: bool = False, how: str = "auto") -> Live:
    say(folder, "name: My exhibition", f"reload: {{replay: {mode}, budget: 20s}}\nname: My exhibition", "lumen.yaml")
    return Live(folder, how, apart=apart)


def test_warn_says_it_and_takes_the_files(folder: Path) -> None:
    live = begin(folder, "warn")
    live.edit("en: Goodbye!", "en: So long!", HELLO)
    live.until_told("are active")
    assert "of 3 visits: 3 say something else" in live.transcript
    assert "would be “So long!” (en) (behaviors/hello.yaml:12:24)" in live.transcript
    body = next(body for body in live.status.bodies if body["verdict"] == "applied")
    said = body["visits"]
    assert (said["visits"], said["same"], said["differing"], said["mode"], said["complete"]) == (3, 0, 3, "warn", True)
    assert said["differ"][0]["place"] == "behaviors/hello.yaml:12:24"
    assert body["took"]["visits"] > 0
    live.edit("en: So long!", "en: So long!  # nothing changes", HELLO)
    live.until(lambda: len(live.verdicts) > 1)
    assert "visits" not in live.status.bodies[-1]
    live.close()


def test_refuse_keeps_the_files_until_a_person_takes_them(folder: Path) -> None:
    live = begin(folder, "refuse")
    before = live.show.loop.project
    live.edit("en: Goodbye!", "en: So long!", HELLO)
    live.until_told("refused: recorded visits would go differently with these files")
    assert "(`lumen reload --apply` activates them anyway)" in live.transcript
    assert live.show.loop.project is before
    answer = live.ask("dry-run")
    assert answer["verdict"] == "judging"
    assert not answer["final"]
    live.until(lambda: live.answers.bodies[-1]["verdict"] == "refused")
    assert live.ask("apply")["verdict"] == "applied"
    assert live.show.loop.project is not before
    live.edit("Hello! I am Nao.", "Hello! I am Nao!", HELLO)
    live.until(lambda: live.verdicts.count("refused") == 2)
    live.edit("Hello! I am Nao!", "Hello! I am Nao.", HELLO)
    live.until(lambda: live.verdicts[-1] == "unchanged")
    live.close()


def test_by_hand_it_is_staged_with_what_it_would_change(folder: Path) -> None:
    live = begin(folder, "refuse", how="manual")
    live.edit("en: Goodbye!", "en: So long!", HELLO)
    live.until_told("`lumen reload --apply` activates it")
    assert "of 3 visits: 3 say something else" in live.transcript
    live.close()


def test_other_files_that_change_no_visit_are_taken(folder: Path) -> None:
    live = begin(folder, "refuse")
    live.edit("30s: waiting", "40s: waiting", HELLO)
    live.until_told("are active")
    assert "of 3 visits: 3 the same" in live.transcript
    live.close()


DIES = """
import os
from lumen.run.reload import validation_process, visits_check
visits_check.check_visits = lambda *_: {ends}
validation_process.main()
"""


@pytest.mark.process
@pytest.mark.slow
@pytest.mark.parametrize(
    ("ends", "told"),
    [
        ("os._exit(3)", "it ended with exit code 3"),
        ("1 / 0", "ZeroDivisionError"),
        ("bytearray(1 << 40)", "more than 1024 MB"),
    ],
)
def test_a_check_that_crashes_costs_the_check_only(
    folder: Path, monkeypatch: pytest.MonkeyPatch, ends: str, told: str
) -> None:
    monkeypatch.setattr(validation_worker, "COMMAND", [sys.executable, "-c", DIES.format(ends=ends)])
    live = begin(folder, "refuse", apart=True)
    live.edit("en: Goodbye!", "en: So long!", HELLO)
    live.until_told("are active")
    assert "the recorded visits were not played with these files: " in live.transcript
    assert told in live.transcript
    live.close()


@pytest.mark.process
@pytest.mark.slow
def test_in_the_process_that_judges_it_is_the_same(folder: Path) -> None:
    live = begin(folder, "refuse", apart=True)
    live.edit("en: Goodbye!", "en: So long!", HELLO)
    live.until_told("refused: recorded visits would go differently with these files")
    assert "of 3 visits: 3 say something else" in live.transcript
    live.close()
