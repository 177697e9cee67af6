"""Output of the long tests, printed as each of them ends: their figures, even from workers."""

import pytest


class Figures:
    """Writes the output of each test marked `soak` to the terminal, and its duration."""

    def __init__(self, terminal: pytest.TerminalReporter) -> None:
        self.terminal = terminal

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.when == "call" and "soak" in report.keywords:
            self.terminal.ensure_newline()
            self.terminal.write_line(f"{report.outcome} in {report.duration:.0f} s: {report.nodeid}")
            if report.capstdout:
                self.terminal.write_line(report.capstdout.rstrip())


@pytest.hookimpl(trylast=True)
def pytest_configure(config: pytest.Config) -> None:
    terminal = config.pluginmanager.get_plugin("terminalreporter")
    if terminal and not hasattr(config, "workerinput"):
        config.pluginmanager.register(Figures(terminal))
