"""Short output for a run of pytest: the time it takes, its progress, the reasons for skipping, and a failed promise.

With `-v` the usual output of pytest returns, but a failure still begins with the promise. The closing line is pytest's.
"""

import os
import re
import shlex
import sys
import time
from collections import Counter
from collections.abc import Callable, Generator, Sequence
from functools import partial
from inspect import getdoc
from math import ceil
from pathlib import Path
from typing import Any

import pytest

EXPECTED, NAME = "expected", "name"
"""Properties of a report: what a failed test expected, and a test's name without the group that xdist appends to it."""
LINES, CHARACTERS = 5, 600
"""The longest finding above a traceback."""
STEP = 10
"""The progress between two lines, without a terminal [%]."""
PAUSE, REDRAW = 5.0, 0.2
"""The least time between two of these lines, and between two drawings of the one on a terminal [s]."""
REASONS = 12
"""The most reasons for skipping that are listed."""
TOOK = "lumen/took"
"""The key in pytest's cache for the last runs: number of tests and duration [s], by their command line."""
KEPT = 20
"""The number of runs in that cache."""
REFERENCE = 0.054
"""The result of `calibration` on the machine of the figures in CONTRIBUTING.md [s]."""


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--expect-cpu", type=float, metavar="SECONDS", help="CPU time of this run on the machine of CONTRIBUTING.md"
    )


def pytest_configure(config: pytest.Config) -> None:
    config.pluginmanager.register(Expectations(), "lumen-expectations")
    if hasattr(config, "workerinput"):
        return
    config.pluginmanager.register(Explanations(config), "lumen-explanations")
    if config.get_verbosity() < 0 and not config.option.collectonly:
        config.option.reportchars = config.option.reportchars.replace("s", "")  # `Progress` lists skips by reason
        config.pluginmanager.register(Progress(config), "lumen-progress")


class Expectations:
    """Adds to the report of a test its name, and its expectation if it failed; runs in the process of the test."""

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(
        self, item: pytest.Item, call: pytest.CallInfo[None]
    ) -> Generator[None, pytest.TestReport, pytest.TestReport]:
        report = yield
        if (name := own_name(item)) != report.nodeid:
            report.user_properties.append((NAME, name))
        if report.failed:
            report.user_properties.append((EXPECTED, expectation(item)))
        return report


def expectation(item: pytest.Item) -> str:
    """Return the promise that a test checks, as a sentence: its docstring's first one, else its name."""
    said = (getdoc(getattr(item, "function", None)) or "").partition("\n")[0].strip()
    name = getattr(item, "originalname", None) or item.name.partition("[")[0]
    sentence = said or name.removeprefix("test_").replace("_", " ")
    case = f" ({item.callspec.id.replace('_', ' ')})" if hasattr(item, "callspec") else ""
    return f"{sentence.rstrip('.')}{case}."


def own_name(item: pytest.Item) -> str:
    """Return the test's name for pytest's command line, without the group that xdist appends."""
    return re.sub(rf"@{re.escape(group)}$", "", item.nodeid) if (group := group_of(item)) else item.nodeid


def group_of(item: pytest.Item) -> str:
    marks = (mark.args[0] if mark.args else mark.kwargs.get("name") for mark in item.iter_markers("xdist_group"))
    return "_".join(sorted({str(name) for name in marks}))


class Explanations:
    """Puts what was expected, what was found, and how to repeat it above the traceback of a failure.

    Tests have the names that pytest's command line knows, so that `--lf` finds those that failed with several workers.
    """

    def __init__(self, config: pytest.Config) -> None:
        self._root = config.rootpath

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        properties = dict(report.user_properties)
        report.nodeid = str(properties.get(NAME, report.nodeid))
        expected = properties.get(EXPECTED)
        if report.failed and expected is not None:
            lines = [f"Expected: {expected}"]
            if found := finding(report.longrepr):
                lines.append(f"Found: {found}")
            lines.append(f"Again: {command(self._root, report.nodeid)}")
            report.toterminal = partial(explain, lines, report.toterminal)  # type: ignore[method-assign]


def explain(lines: Sequence[str], failure: Callable[[Any], None], terminal: Any) -> None:
    """Write these lines, and then the failure as pytest writes it."""
    for line in lines:
        terminal.line(line, bold=True)
    failure(terminal)


def finding(failure: Any) -> str:
    """Return the message of the exception, shortened; empty if pytest prints nothing but that message anyway."""
    message = getattr(getattr(failure, "reprcrash", None), "message", "")
    if str(failure).strip() == message.removeprefix("Failed: ").strip():
        return ""
    lines = [line for line in re.sub(r"^(AssertionError|Failed): ", "", message).splitlines() if line.strip()]
    short = "\n".join(lines[:LINES])[:CHARACTERS]
    return short + " …" if len(short) < len("\n".join(lines)) else short


def command(root: Path, name: str) -> str:
    """Return the command that runs one test from the project's folder."""
    python = Path(sys.executable)
    start = str(python.relative_to(root)) if python.is_relative_to(root) else str(python)
    unpacked = "sh scripts/with_packages.sh " if (root / ".cache/debian/root").is_dir() else ""
    return f"{unpacked}{start} -m pytest {shlex.quote(name)}"


class Progress:
    """Print the progress of a run instead of dots: on one line of a terminal, else after each tenth of the run.

    The name of a failed test is printed at once, because a run may last long or be stopped.
    """

    def __init__(self, config: pytest.Config) -> None:
        self._config = config
        self._workers: int = config.getoption("numprocesses", None) or 1
        self._began = self._drawn = time.monotonic()
        self._tests = self._done = self._percent = 0
        self._failed: set[str] = set()
        self._expected: float | None = None
        self._width = 0
        self._runs = False

    @property
    def _terminal(self) -> pytest.TerminalReporter:
        return self._config.pluginmanager.getplugin("terminalreporter")

    def pytest_collection_finish(self, session: pytest.Session) -> None:
        if self._workers == 1 and not self._config.getoption("tx", None):
            self._begin(len(session.items))

    @pytest.hookimpl(optionalhook=True)
    def pytest_xdist_node_collection_finished(self, node: object, ids: Sequence[str]) -> None:
        if not self._runs:
            self._begin(len(ids))

    def _begin(self, tests: int) -> None:
        self._tests, self._runs, self._began = tests, True, time.monotonic()
        self._expected = self._expectation()
        if self._expected is not None:
            beside = f", {self._workers} at a time" if self._workers > 1 else ""
            self._write(f"{tests:,} test{'s' * (tests != 1)}{beside}: takes about {duration(self._expected)}")

    def _expectation(self) -> float | None:
        """Return how long this run will take [s]: as the last one of the same words, else by its CPU time.

        The last one does not count if it had less than half as many tests, such as the slowest only.
        """
        tests, seconds = self._took().get(self._words(), (0, 0.0))
        if tests and 2 * tests >= self._tests:
            return seconds * self._tests / tests
        if (cpu := self._config.getoption("expect_cpu")) is None:
            return None
        return float(cpu * calibration() / REFERENCE / min(self._workers, os.cpu_count() or 1))

    def _words(self) -> str:
        option = self._config.option
        suite = self._config.getoption("suite", "all")
        return f"{self._workers} {suite} {option.markexpr} {option.keyword} {' '.join(self._config.args)}"

    def _took(self) -> dict[str, tuple[int, float]]:
        cache = getattr(self._config, "cache", None)
        return dict(cache.get(TOOK, {})) if cache else {}

    @pytest.hookimpl(wrapper=True)
    def pytest_report_teststatus(self) -> Generator[None, Any, Any]:
        """Keep the category that is counted, without the letter that would be printed."""
        status = yield
        return (status[0], "", "") if self._runs else status

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.failed and report.nodeid not in self._failed:
            self._failed.add(report.nodeid)
            if self._runs:
                self._write(f"      failed: {dict(report.user_properties).get(NAME, report.nodeid)}")

    def pytest_runtest_logfinish(self) -> None:
        self._done += 1
        now = time.monotonic()
        if self._terminal.isatty:
            if now - self._drawn >= REDRAW:
                self._draw(self._state(), now)
        elif self._done < self._tests and now - self._drawn >= PAUSE and self._share() * 100 >= self._percent + STEP:
            self._percent = int(self._share() * 100) // STEP * STEP
            self._drawn = now
            self._write(self._state())

    def _share(self) -> float:
        return min(self._done / self._tests, 1.0) if self._tests else 1.0

    def _state(self) -> str:
        failed = f"{len(self._failed)} failed" if self._failed else "none failed"
        left = time_left(self._share(), time.monotonic() - self._began, self._expected)
        end = f", about {duration(left)} left" if left is not None else ""
        return f"{self._share():4.0%}  {self._done:,} of {self._tests:,} tests, {failed}{end}"

    def _draw(self, text: str, now: float) -> None:
        text = text[: self._terminal._tw.fullwidth - 1]
        self._terminal.rewrite(text.ljust(self._width))
        self._width, self._drawn = len(text), now

    def _write(self, line: str) -> None:
        self._clear()
        self._terminal.write_line(line)

    def _clear(self) -> None:
        if self._terminal.isatty:
            self._draw("", time.monotonic())
            self._terminal.rewrite("")

    @pytest.hookimpl(tryfirst=True)
    def pytest_sessionfinish(self, exitstatus: int) -> None:
        self._clear()
        self._runs = False
        cache = getattr(self._config, "cache", None)
        if cache and self._tests and self._done == self._tests:
            took = self._took()
            took.pop(self._words(), None)
            took[self._words()] = self._tests, round(time.monotonic() - self._began, 1)
            cache.set(TOOK, dict(list(took.items())[-KEPT:]))

    def pytest_terminal_summary(self, terminalreporter: pytest.TerminalReporter) -> None:
        skipped = Counter(reason(report) for report in terminalreporter.stats.get("skipped", ()))
        if not skipped:
            return
        terminalreporter.write_line("Skipped:")
        for why, count in skipped.most_common(REASONS):
            terminalreporter.write_line(f"{count:6,}  {why}")
        if (more := len(skipped) - REASONS) > 0:
            terminalreporter.write_line(f"        and for {more} other reasons, which `-v -rs` lists")


def time_left(share: float, passed: float, expected: float | None) -> float | None:
    """Return the time until the end of a run [s]: at first as expected, then more and more as it has been so far."""
    so_far = passed * (1 - share) / share if share else 0.0
    if expected is None:
        return so_far if share > 0.05 else None
    return share * so_far + (1 - share) * max(expected - passed, 0.0)


def reason(report: Any) -> str:
    """Return why a test was skipped, on one line."""
    why = report.longrepr[-1] if isinstance(report.longrepr, tuple | list) else report.longrepr
    return " ".join(str(why).removeprefix("Skipped: ").split())


def duration(seconds: float) -> str:
    """Return a duration that a person can use: seconds, or minutes from a minute and a half on."""
    return f"{seconds / 60:.0f} minutes" if seconds >= 90 else f"{max(ceil(seconds), 1)} s"


def calibration() -> float:
    """Return the processor time that a fixed piece of Python takes here [s]."""
    taken = []
    for _ in range(3):
        began = time.process_time()
        sum(number * number % 7 for number in range(1_000_000))
        taken.append(time.process_time() - began)
    return min(taken)
