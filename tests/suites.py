"""The two suites: `--suite test` is what `make test` runs, `--suite rest` all others; without the option all run.

`make test` proves the product and guards each commit. It runs everything deterministic (virtual time, no process, no
network, no physics), and a few real tests marked `once`: one broker, one browser, one physics. A test is in the
rest if it uses one of `REAL`, which `tests/marking.py` finds in its code, or if it is marked `rest` by hand because it
is expensive. The mark is checked: in `make test` a test without `once` fails if it starts a process or opens a
connection. So does one that reads a project as `lumen run` does, for a process reads it unless an earlier test did.
"""

import sys
from collections.abc import Generator, Mapping
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from lumen.language.projects import Project

REAL = ("broker", "browser", "network", "npm", "physics", "process")
"""The marks of tests with real, slow and nondeterministic parts."""
TOUCHES = {
    "subprocess.Popen": "starts a process",
    "os.fork": "starts a process",
    "os.posix_spawn": "starts a process",
    "socket.bind": "opens a port",
    "socket.connect": "opens a connection",
}
"""Audit events of the interpreter that a deterministic test does not raise, and their meanings."""


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--suite", choices=("test", "rest", "all"), default="all", help="run a part of the tests")
    parser.addoption("--touches", metavar="FILE", help="write down which tests start a process or open a connection")


def pytest_configure(config: pytest.Config) -> None:
    if config.getoption("--suite") == "test" or config.getoption("--touches"):
        config.pluginmanager.register(Touches(config.getoption("--touches")))


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Mark the rest, and leave out the tests of the other suite."""
    for item in items:
        if in_rest(item) and not item.get_closest_marker("rest"):
            item.add_marker("rest")
    suite = config.getoption("--suite")
    if suite != "all":
        kept = [item for item in items if bool(item.get_closest_marker("rest")) == (suite == "rest")]
        kept_ids = {id(item) for item in kept}
        config.hook.pytest_deselected(items=[item for item in items if id(item) not in kept_ids])
        items[:] = kept


def in_rest(item: pytest.Item) -> bool:
    """Return whether only `make test-all` runs this test."""
    marks = {mark.name for mark in item.iter_markers()}
    return "soak" in marks or "rest" in marks or ("once" not in marks and bool(marks.intersection(REAL)))


def importing() -> bool:
    """Return whether a module is being imported: glfw then starts a process, in the first test that needs it."""
    frame: FrameType | None = sys._getframe()
    while frame and not frame.f_code.co_filename.startswith("<frozen importlib"):
        frame = frame.f_back
    return frame is not None


class Touches:
    """Watches what each test starts and opens; a test that is neither `once` nor in the rest fails for it."""

    def __init__(self, file: str | None) -> None:
        self._file, self._found = file, set[str]()
        sys.addaudithook(self._hear)
        from lumen.run.reload import validation_worker

        self._recall = validation_worker.recall
        pytest.MonkeyPatch().setattr(validation_worker, "recall", self._recalled)

    def _hear(self, event: str, arguments: tuple[Any, ...]) -> None:
        if event in TOUCHES and not importing():
            self._found.add(TOUCHES[event])

    def _recalled(self, root: Path, files: Mapping[str, bytes]) -> "Project | None":
        """Recall a project, and count the process that it would take if it were not kept."""
        self._found.add(TOUCHES["subprocess.Popen"])
        return self._recall(root, files)

    @pytest.hookimpl(wrapper=True, tryfirst=True)
    def pytest_runtest_setup(self, item: pytest.Item) -> Generator[None]:
        self._found.clear()
        return (yield)

    @pytest.hookimpl(wrapper=True, tryfirst=True)
    def pytest_runtest_teardown(self, item: pytest.Item) -> Generator[None]:
        result = yield
        if self._found and self._file:
            with open(self._file, "a", encoding="utf-8") as file:
                file.write(f"{item.nodeid}\t{', '.join(sorted(self._found))}\n")
        elif self._found and not item.get_closest_marker("once"):
            what = " and ".join(sorted(self._found))
            pytest.fail(f"this test {what}: mark it `once`, or `rest` (tests/suites.py)", pytrace=False)
        return result
