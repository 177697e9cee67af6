"""Options that features add to `lumen run` and `lumen lint`."""

import argparse
from collections.abc import Callable, Mapping, Sequence
from functools import cache
from typing import TYPE_CHECKING, Any, Protocol

from lumen.cli.streams import complain
from lumen.errors import LumenError
from lumen.feature import Feature, distribution_of, resolve, rows
from lumen.project.broken_features import faults_reported, shown

if TYPE_CHECKING:  # not at run time: `lumen lint` of unchanged files loads none of them
    from lumen.language.projects import Project
    from lumen.language.stories import Story
    from lumen.run.linting.findings import Findings
    from lumen.run.linting.targets import Wanted


class RunExtra(Protocol):
    """Options of `lumen run`, and what they change in an exhibition."""

    def configure(self, parser: argparse.ArgumentParser) -> None:
        """Add these options to `parser`, the parser of `lumen run`."""
        ...

    def check(self, options: argparse.Namespace, parts: Sequence[str], robots: int) -> None:
        """Raise UsageError if the options don't fit these parts of an exhibition, or this number of robots."""
        ...

    def wishes(
        self, options: argparse.Namespace, project: "Project", story: "Story | None", period: float | None
    ) -> Mapping[str, Any]:
        """Return options, by name, for the plan of one robot that runs for `period` [s]; None for no limit.

        The core itself reads two of them: `track`, an `AudioTrack` that receives all the robot's sound, and `video`,
        the path of the film that is written. Raises UsageError if the options can't be fulfilled.
        """
        ...


class LintExtra(Protocol):
    """Options of `lumen lint`, and the findings that they add."""

    def configure(self, parser: argparse.ArgumentParser) -> None:
        """Add these options to `parser`, the parser of `lumen lint`."""
        ...

    def check(self, options: argparse.Namespace) -> None:
        """Raise UsageError if the options contradict each other."""
        ...

    def more(self, found: Sequence["Findings"], wanted: "Wanted", options: argparse.Namespace) -> list["Findings"]:
        """Return `found`, the findings of each project, with those that the options add."""
        ...


@cache
def _used(kind: str) -> list[tuple[Feature, str]]:
    """Return the rows of a kind. A row is removed after the first fault of its package."""
    return [*rows(kind)]


def of_extras(kind: str, call: Callable[[Any], Any], *, installed: bool | None = None) -> list[Any]:
    """Return the result of `call` for each class of options in the rows of a kind, in the order of the features.

    `installed` chooses those of installed packages, or those that come with Lumen. LumenErrors are raised. After any
    other error of a package, its options are left out until the command ends, and the fault is printed.
    """
    found: list[Any] = []
    for feature, where in [*_used(kind)]:
        if installed in (None, bool(distribution_of(feature))):
            with faults_reported(feature, f"its options `{where}`", lambda fault: complain(str(fault)), LumenError):
                found.append(call(resolve(where)()))
                continue
            _used(kind).remove((feature, where))
    return found


def returned(value: Any, form: Any, kind: type) -> Any:
    """Return a value that a package returned. Raises TypeError if it is no `form`, such as a list, of that kind."""
    if not isinstance(value, form) or not all(isinstance(each, kind) for each in value):
        raise TypeError(f"it returned {shown(value)} instead of a {form.__name__.lower()} of {kind.__name__}")
    return value
