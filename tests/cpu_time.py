"""The processor time of tests: `--cpu-limit SECONDS` lists those that exceed it, and prints the sum.

Processor time, since a crowded machine lets any test wait. A test's setup and teardown count, and the processes that it
has waited for; a shared fixture counts for the first test that uses it.
"""

import os
from collections.abc import Generator

import pytest

BEGAN = pytest.StashKey[float]()
PROPERTY = "cpu_time"


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption("--cpu-limit", type=float, metavar="SECONDS", help="tell of tests that take more CPU time")


@pytest.hookimpl(wrapper=True)
def pytest_runtest_protocol(item: pytest.Item) -> Generator[None, bool, bool]:
    item.stash[BEGAN] = cpu_time()
    return (yield)


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(
    item: pytest.Item, call: pytest.CallInfo[None]
) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    report = yield
    if report.when == "teardown":
        report.user_properties.append((PROPERTY, cpu_time() - item.stash[BEGAN]))
    return report


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter, config: pytest.Config) -> None:
    limit = config.getoption("--cpu-limit")
    if limit is None:
        return
    reports = [report for reports in terminalreporter.stats.values() for report in reports]
    properties = [(report.nodeid, dict(getattr(report, "user_properties", ()))) for report in reports]
    taken = sorted(((found[PROPERTY], name) for name, found in properties if PROPERTY in found), reverse=True)
    over = [(time, name) for time, name in taken if time > limit]
    terminalreporter.section(f"{sum(time for time, _ in taken):.1f} s of CPU time in {len(taken)} tests")
    for time, name in over:
        terminalreporter.write_line(f"{time:6.2f} s  {name}")
    if over:
        terminalreporter.write_line(f"These took more than {limit:g} s: make them cheaper, or mark them `slow`.")


def cpu_time() -> float:
    """Return the processor time of this process and of those that it has waited for [s]."""
    return sum(os.times()[:4])
