"""The start and the end of a run, of one robot or several: homes, files, and reports of errors to people."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from functools import cache
from pathlib import Path

from lumen.errors import BusError, LumenError, ModuleError, ProjectError, RobotError, UsageError
from lumen.feature import Feature, described, resolve, rows
from lumen.language.diagnostics import Severity
from lumen.language.projects import Project
from lumen.project.broken_features import called, faults_reported, package_at_fault
from lumen.project.main_file import main_settings
from lumen.project.settings import Settings
from lumen.run.presence import BRAIN, ROBOT_PART
from lumen.run.recovery.run_directory import RunDirectory
from lumen.run.recovery.startup import startup_project

WHOLE = (ROBOT_PART, BRAIN)
"""The parts that every exhibition in one process has."""
OUTSIDE = (BusError, RobotError, ModuleError)
"""Errors of the environment: the files are not their cause, so the next start does not count them as a crash."""


@dataclass(frozen=True, slots=True)
class RunFailure:
    """An error that ended a run, or one robot of it, at its start or later."""

    kind: str
    """`start` for a fault of files or of the environment, `crashed` for one of code."""
    text: str
    """A description, with only a place and a code from the files."""
    root: Path
    """The folder of the project."""
    name: str
    """The name of the project."""
    robot: str
    """The names of the robots that ended, separated by commas."""
    parts: tuple[str, ...]
    """The parts that the process had."""
    settings: Settings | None
    """The settings that could be read; None if none could."""
    last_good: Callable[[], Project | None]
    """Returns the last good project; None if there is none."""
    tell: Callable[[str], None]
    """Prints a line, such as why an alert could not be sent."""


class Failures:
    """Sends people reports of errors that end a run, or one robot of it; `close` waits until all are sent.

    A UsageError is only for the person at the terminal. `tell` is called with the reason if a report can't be sent.
    Without `wanted` nothing is sent, as for stories.
    """

    def __init__(
        self,
        root: Path,
        directories: Mapping[str, RunDirectory],
        parts: Sequence[str],
        tell: Callable[[str], None],
        *,
        wanted: bool,
    ) -> None:
        self._root, self._directories, self._parts, self._tell = root, directories, parts, tell
        self._wanted = wanted
        self._waiting: list[tuple[Feature, str, Callable[[], None]]] = []

    def report(self, error: Exception, robots: Sequence[str]) -> None:
        """Report an error that ended these robots; an error of the environment does not count as a crash."""
        if self._wanted and not isinstance(error, UsageError | BrokenPipeError):  # the latter: the reader has gone
            for feature, where in rows("failures"):
                try:
                    if wait := called(feature, where, self._failure(error, robots)):
                        self._waiting.append((feature, where, wait))
                except Exception as other:
                    self._tell(f"no alert could be sent: {described(other)}")
        if isinstance(error, OUTSIDE):
            for robot in robots:
                self._directories[robot].records.annul()

    def close(self) -> None:
        """Wait until all reports are sent."""
        for feature, where, wait in self._waiting:
            with faults_reported(feature, f"its `{where}`", lambda fault: self._tell(str(fault))):
                wait()

    def _failure(self, error: Exception, robots: Sequence[str]) -> RunFailure:
        directory = self._directories[robots[0]]
        settings = main_settings(self._root, directory.robot)
        name = (settings and settings.name) or self._root.name
        robot = ", ".join(filter(None, robots)) or (settings.robot if settings else "NAO")
        kind, text = "start", f"it could not start or continue: {_why(error)}" if isinstance(error, LumenError) else ""
        if not isinstance(error, LumenError):  # the message of an internal error may contain private data
            where = f"the package {package}" if (package := package_at_fault(error)) else "Lumen"
            kind, text = "crashed", f"it ended because of a fault in {where} ({type(error).__name__})"
        parts, last_good = tuple(self._parts), directory.last_good
        return RunFailure(kind, text, self._root, name, robot, parts, settings, last_good, self._tell)


@dataclass(frozen=True, slots=True)
class BegunRun:
    """The homes and projects of a run's robots."""

    root: Path
    directories: Mapping[str, RunDirectory]
    """The homes, by robot; the name is empty if the project has one robot."""
    projects: Mapping[str, Project]
    """The bundles, by robot."""
    failures: Failures
    """Reports errors that end the run."""


@contextmanager
def started(
    root: Path,
    robots: Sequence[str],
    parts: Sequence[str],
    *,
    last_good: bool,
    alerted: bool,
    tell: Callable[[str], None],
) -> Iterator[BegunRun]:
    """Hold the homes of these robots, finish an interrupted installation, and read the files.

    The homes are released at the end. An error before or during the run is reported to the people in `alerts` if
    `alerted`, and raised again.
    """
    guest = bool(parts) and BRAIN not in parts
    names = tuple(robots) or ("",)
    with ExitStack() as stack:
        directories: dict[str, RunDirectory] = {}
        for name in names:
            directories[name] = RunDirectory(root, name, guest=guest)
            stack.callback(directories[name].close, forget=False)
        once = cache(tell)  # the files of several robots can have the same fault
        failures = Failures(root, directories, parts or WHOLE, tell, wanted=alerted)
        stack.callback(failures.close)
        try:
            for feature, where in rows("before_start"):
                with faults_reported(feature, f"its `{where}`", lambda fault: tell(str(fault)), LumenError):
                    resolve(where)(root)
            projects = {
                name: startup_project(root, directory, last_good=last_good, warn=tell, tell_fault=once)
                for name, directory in directories.items()
            }
            yield BegunRun(root, directories, projects, failures)
        except Exception as error:
            failures.report(error, names)
            raise


def _why(error: LumenError) -> str:
    """Return an error's message; for errors in files only the place and the code of the first one, without content."""
    if not isinstance(error, ProjectError):
        return str(error)
    found = [diagnostic for diagnostic in error.diagnostics if diagnostic.severity is Severity.ERROR]
    return (
        f"the project's files have errors, the first at {found[0].place}: {found[0].code}"
        if found
        else "the project's files have errors"
    )
