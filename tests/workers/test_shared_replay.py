"""A journal that several workers replay: the report equals that of one."""

from pathlib import Path

import pytest

import lumen
from lumen.project.files import read_files
from lumen.run.replaying import shared_replay as shared
from lumen.run.replaying.journals import KeptBundles, chosen
from lumen.run.replaying.other_files import against
from lumen.run.replaying.replay_report import ReplayReport, replayed
from lumen.run.workers.workers import Workers
from tests import ROOT
from tests.copying import copied_project


@pytest.fixture(scope="module")
def played(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A small exhibition after several visits, one after the other."""
    folder = copied_project(ROOT / "examples/minimal", tmp_path_factory.mktemp("played") / "minimal")
    (story,) = (folder / "behaviors" / "stories").glob("*.yaml")
    text = story.read_text("utf-8")
    head, _, steps = text.partition("steps:\n")
    story.write_text(head + "steps:\n" + steps.rstrip("\n") + "\n" + (steps.rstrip("\n") + "\n") * 4, "utf-8")
    with lumen.open(folder, story=story.stem) as exhibition:
        exhibition.run()
    return folder


def both(folder: Path, workers: Workers, other: dict[str, bytes] | None) -> tuple[ReplayReport, ReplayReport]:
    """Return the report of one process, and that of the workers."""
    journal, bundles = chosen(folder, None), KeptBundles(folder)
    kit = shared.replay_kit(journal, bundles, other)
    if other is None:
        here = replayed(journal.entries(), bundles.machine)
        return here, shared.shared_replay(journal.entries(), bundles, kit, workers)
    new = lumen.lint.check_files(folder, other)[0]
    assert new
    here = against(journal.entries(), bundles, new)
    return here, shared.shared_against(journal.entries(), bundles, kit, workers)


def ahoy(folder: Path) -> dict[str, bytes]:
    return {name: content.replace(b"Hello", b"Ahoy") for name, content in read_files(folder).items()}


@pytest.mark.parametrize("entries", [1, 3, 1000])
def test_a_journal_that_is_cut_comes_to_the_same(played: Path, entries: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shared, "ENTRIES", entries)
    rows = [(entry, None) for entry in chosen(played, None).entries()]
    assert (len(list(shared._parts(rows))) > 2) == (entries < 1000)
    here, there = both(played, Workers(1), None)
    assert here.visits > 1
    assert there == here


@pytest.mark.parametrize("visits", [1, 2])
def test_visits_with_other_files_keep_their_numbers(played: Path, visits: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shared, "VISITS", visits)
    here, there = both(played, Workers(1), ahoy(played))
    assert len(here.differ) > 1
    assert there == here


@pytest.mark.process
@pytest.mark.slow
def test_two_processes_report_what_one_does(played: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(shared, "VISITS", 1)
    here, there = both(played, Workers(2), ahoy(played))
    assert there == here
