"""A fault at every step of loading, linting, planning and applying files costs the reload, and nothing else.

The steps are those that a reload takes: no list of them is kept here.
"""

import pickle
import random
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from types import CodeType

import pytest

from lumen.project.common_words import COMMON_FILE
from lumen.project.files import read_files
from lumen.run.reload.reloader import Reloader
from lumen.run.reload.validator import Validation
from lumen.run.watcher import SavedFiles
from tests.live.faults import failing, name, steps
from tests.live.shows import Live

pytestmark = pytest.mark.rest  # expensive

ROUTE = "routes:\n  load: {key: lumen.load, direction: in, event: load}\n"
REGION = """
  load:
    initial: counting
    states:
      counting:
        entry: {say: Hello}
        exit: {say: Bye}
        on: {load: {actions: {log: heard}}}
"""
SAMPLE = 8


class Bench:
    """Files judged and taken step by step, on the thread of the test."""

    def __init__(self, folder: Path) -> None:
        self.live = Live(folder)
        self.reloading = self.live.reloading
        self._first = read_files(folder)
        self._number = 0

    def saved(self, more: bool = False) -> SavedFiles:
        """Return new versions of all kinds of files, never saved before; with `more`, they add a route and a region."""
        self._number += 1
        mark = f"\n# {self._number}\n".encode()
        marked = {path: content + mark for path, content in self._first.items() if _ours(path)}
        files = {**self._first, **marked}
        if more:
            files["lumen.yaml"] = files["lumen.yaml"].replace(b"routes:\n", ROUTE.encode(), 1)
            files["behaviors/tour.yaml"] += REGION.encode()
        return SavedFiles(files, (), 0.0, 0.0)

    def validation(self, saved: SavedFiles) -> Validation:
        return self.reloading._judge(saved)

    def take(self, validation: Validation) -> None:
        """Hand the validation over, and tick: its files are applied or refused."""
        self.reloading._watcher.results.put(validation)
        self.live.show.tick()

    @property
    def hash(self) -> str:
        """The hash of the bundle that runs."""
        return self.live.show.loop.project.hash

    def is_whole(self) -> bool:
        """Return whether the inbox and the state match the bundle that runs."""
        exhibition = self.live.show.loop
        listens = ("lumen.load", "load") in exhibition.inbox._undo
        stands = any(state.endswith("counting") for state in exhibition.runtime.snapshot.configuration)
        return listens == stands == ("load" in exhibition.project.routes)


def _ours(path: str) -> bool:
    """Return whether that file is marked: not stories, which would be played, nor the words that come with Lumen."""
    return path.endswith(".yaml") and path != COMMON_FILE and not path.startswith(("models/", "behaviors/stories/"))


@pytest.fixture
def bench(copy: Path, caplog: pytest.LogCaptureFixture) -> Iterator[Bench]:
    caplog.set_level("CRITICAL")
    one = Bench(copy)
    for _ in range(2):  # what is worked out once and for all is no step of a reload
        assert one.validation(one.saved()).good
    yield one
    one.live.close()


every = pytest.mark.parametrize("every", [False, pytest.param(True, marks=pytest.mark.soak)])


def some(found: list[CodeType], every: bool) -> list[CodeType]:
    return found if every else random.Random(1).sample(found, SAMPLE)


@pytest.mark.slow
@every
def test_a_fault_in_loading_or_linting(bench: Bench, every: bool) -> None:
    saved, running = bench.saved(), bench.live.show.loop.project
    found = steps(lambda: bench.validation(saved), Reloader._judge)
    assert len(found) > 500
    for step in some(found, every):
        saved = bench.saved()
        validation = failing(step, lambda: bench.validation(saved), Reloader._judge)  # noqa: B023 called at once
        assert name(step) in validation.fault
        bench.take(validation)
        assert bench.live.show.loop.project is running
        assert (
            f"refused: an error in Lumen prevented the check of these files: FaultError('{name(step)}')"
            in bench.live.transcript
        )
    bench.take(bench.validation(bench.saved()))
    assert bench.live.verdicts[-1] == "applied"


def fresh(validation: Validation) -> Callable[[], Validation]:
    """Return a function that makes the validation anew, with nothing in it compiled or worked out."""
    packed = pickle.dumps(replace(validation.project, documents={}) if validation.project else None)
    return lambda: replace(validation, project=pickle.loads(packed), running=None)


@pytest.mark.slow
@every
@pytest.mark.parametrize("forth", [True, False])
def test_a_fault_in_planning_or_applying(bench: Bench, forth: bool, every: bool) -> None:
    """After a fault the verdict is true, no bundles are mixed, and the next files load, with parts added or removed."""
    new, old = [fresh(bench.validation(bench.saved(more))) for more in (forth, not forth)]
    for validation in (old(), new(), old()):  # once and for all, too
        bench.take(validation)
    found = steps(lambda: bench.take(new()), Reloader.tick)
    assert len(found) > 100
    for step in some(found, every):
        bench.take(old())
        assert bench.hash == old().hash
        told = len(bench.live.verdicts)
        failing(step, lambda: bench.take(new()), Reloader.tick)
        assert bench.is_whole(), name(step)
        last = bench.live.verdicts[told:][-1:]
        true = [["applied"]] if bench.hash == new().hash else [["refused"], ["rolled back"]]
        assert last in ([], *true), name(step)
    bench.take(old())
    bench.take(new())
    assert bench.hash == new().hash
