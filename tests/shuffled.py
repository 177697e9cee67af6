"""Tests in random order: `-p tests.shuffled --order-seed N`; without a seed one is drawn, and printed.

Shuffled are whole groups of xdist (else files), the files of a group, and the tests within a file. A file whose tests
build on each other has `pytestmark = pytest.mark.ordered`, and keeps its order. `scripts/shaken.py` uses this
with `--outcomes FILE`, which gets a line of JSON for each test, and `--only-real`, which leaves only tests with a
process, a broker or a browser.
"""

import json
import random
import re
from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

import pytest

REAL = ("process", "broker", "browser")
"""The marks of tests that start something."""


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--order-seed", type=int, metavar="N", help="the seed of the tests' random order")
    parser.addoption("--outcomes", type=Path, metavar="FILE", help="where each test's outcome is written")
    parser.addoption("--only-real", action="store_true", help="only tests with a process, a broker or a browser")


@pytest.hookimpl(tryfirst=True)
def pytest_configure(config: pytest.Config) -> None:
    """Draw a seed before workers are begun: all of them must collect the same tests in the same order."""
    if config.getoption("order_seed") is None:
        config.option.order_seed = random.SystemRandom().randrange(1_000_000)
    file = config.getoption("outcomes")
    if file and not hasattr(config, "workerinput"):
        config.pluginmanager.register(Outcomes(file))


class Outcomes:
    """Writes `[test, outcome]` for each test, failed if any part of it failed; a failed one also has its traceback.

    pytest itself prints tracebacks when a run ends, which may be hours later.
    """

    def __init__(self, file: Path) -> None:
        self.file = file

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.when == "call" or report.outcome != "passed":
            self._write(report)

    def pytest_collectreport(self, report: pytest.CollectReport) -> None:
        if report.failed:
            self._write(report)

    def _write(self, report: pytest.TestReport | pytest.CollectReport) -> None:
        """Append a line, without the group that xdist puts behind a test's name."""
        line = [re.sub(r"@[^]@]*$", "", report.nodeid), report.outcome]
        with self.file.open("a", encoding="utf-8") as file:
            file.write(json.dumps([*line, report.longreprtext] if report.failed else line) + "\n")


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter, config: pytest.Config) -> None:
    terminalreporter.write_line(f"random order: --order-seed {config.getoption('order_seed')}")


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    if config.getoption("only_real"):
        kept = [item for item in items if is_real(item)]
        config.hook.pytest_deselected(items=[item for item in items if not is_real(item)])
        items[:] = kept
    items[:] = shuffled(items, random.Random(config.getoption("order_seed")))


def shuffled(items: Iterable[pytest.Item], order: random.Random) -> list[pytest.Item]:
    found: list[pytest.Item] = []
    for group in mixed(items, group_of, order):
        for file in mixed(group, file_of, order):
            if file[0].get_closest_marker("ordered") is None:
                order.shuffle(file)
            found += file
    return found


def mixed(
    items: Iterable[pytest.Item], key: Callable[[pytest.Item], str], order: random.Random
) -> Iterator[list[pytest.Item]]:
    """Yield the tests of each key, the keys in random order."""
    groups: dict[str, list[pytest.Item]] = {}
    for item in items:
        groups.setdefault(key(item), []).append(item)
    names = sorted(groups)
    order.shuffle(names)
    yield from (groups[name] for name in names)


def group_of(item: pytest.Item) -> str:
    mark = item.get_closest_marker("xdist_group")
    return str(mark.args[0] if mark and mark.args else file_of(item))


def file_of(item: pytest.Item) -> str:
    return item.nodeid.partition("::")[0]


def is_real(item: pytest.Item) -> bool:
    """Return whether the test has a process, a broker or a browser, as `tests/marking.py` finds."""
    return any(item.get_closest_marker(mark) for mark in REAL)
