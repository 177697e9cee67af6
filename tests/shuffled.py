"""Tests in random order: `-p tests.shuffled --order-seed N`; without a seed one is drawn, and printed.

Shuffled are whole groups of xdist (else files), the files of a group, and the tests within a file. A file whose tests
build on each other says so with `pytestmark = pytest.mark.ordered`, and keeps its order. `scripts/shaken.py` uses this
with `--outcomes FILE`, which gets a line of JSON for each test, and `--only-real`, which leaves only tests with a
process, a broker or a browser.
"""

import json
import random
import re
from collections.abc import Callable, Iterable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

import pytest

from tests.marking import home, named, parameters

REAL = ("tests.guarded", "tests.rabbitmq", "subprocess", "multiprocessing", "selenium")
"""The modules by which tests start a process, a broker or a browser."""
BROWSING = ("browser", "page", "driver")
"""Fixtures that are a browser."""


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
    """Writes `[test, outcome]` for each test: failed if any part of it failed."""

    def __init__(self, file: Path) -> None:
        self.file = file

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.when == "call" or report.outcome != "passed":
            self._write(report.nodeid, report.outcome)

    def pytest_collectreport(self, report: pytest.CollectReport) -> None:
        if report.failed:
            self._write(report.nodeid, report.outcome)

    def _write(self, test: str, outcome: str) -> None:
        """Append a line, without the group that xdist puts behind a test's name."""
        with self.file.open("a", encoding="utf-8") as file:
            file.write(json.dumps([re.sub(r"@[^]@]*$", "", test), outcome]) + "\n")


def pytest_report_header(config: pytest.Config) -> str:
    return f"random order: --order-seed {config.getoption('order_seed')}"


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
    """The tests by that key, in random order."""
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
    """Whether a test, its fixtures or its parameters name what starts a process, a broker or a browser."""
    if item.get_closest_marker("broker") or not isinstance(item, pytest.Function):
        return True
    fixtures = item._fixtureinfo.name2fixturedefs
    used = [item.function, *(definition.func for found in fixtures.values() for definition in found)]
    used += [value for value in parameters(item) if callable(value)]
    return any(name in BROWSING for name in fixtures) or any(starts(thing) for thing in used)


@cache
def starts(thing: Any) -> bool:
    """Whether a function or class of the tests, or one that it names, starts something."""
    seen, left = set[int](), [thing]
    while left:
        one = left.pop()
        if id(one) in seen:
            continue
        seen.add(id(one))
        if home(one).startswith(REAL):
            return True
        if home(one).startswith("tests."):
            left += named(one)
    return False
