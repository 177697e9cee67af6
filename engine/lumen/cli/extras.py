"""Options that features add to `lumen run` and `lumen lint`."""

import argparse
from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Protocol

from lumen.feature import rows
from lumen.project.broken_features import called

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


def run_extras() -> Iterator[RunExtra]:
    """Return the options that features add to `lumen run`, in the order of the features."""
    return (called(feature, where) for feature, where in rows("run_options"))


def lint_extras() -> Iterator[LintExtra]:
    """Return the options that features add to `lumen lint`, in the order of the features."""
    return (called(feature, where) for feature, where in rows("lint_options"))
