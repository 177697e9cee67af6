"""Options that features add to `lumen run` and `lumen lint`."""

import argparse
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Protocol, TypeVar

from lumen.cli.streams import complain
from lumen.errors import LumenError
from lumen.feature import distribution_of, resolve, rows
from lumen.project.broken_features import faults_told

if TYPE_CHECKING:  # not at run time: `lumen lint` of unchanged files loads none of them
    from lumen.language.projects import Project
    from lumen.language.stories import Story
    from lumen.run.linting.findings import Findings
    from lumen.run.linting.targets import Wanted

T = TypeVar("T")


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


def configure_extras(parser: argparse.ArgumentParser, kind: str, *, installed: bool) -> None:
    """Add the options of the rows of a kind to a parser: those of installed packages, or those that come with Lumen.

    Those of packages come last, so that no option of Lumen meets one of the same name. A package's options with a fault
    are left out, and the fault is printed.
    """
    extras = parser.get_default("extras") or []
    parser.set_defaults(extras=extras)
    for feature, where in rows(kind):
        if installed == bool(distribution_of(feature)):
            with faults_told(feature, f"its options `{where}`", complain):
                extra = resolve(where)()
                extra.configure(parser)
                extras.append((feature, where, extra))


def of_extras(options: argparse.Namespace, call: Callable[[Any], T]) -> list[T]:
    """Return the result of `call` for each class of options that features added, in the order of the features.

    LumenErrors are raised. After any other error of a package, its options are left out, and the fault is printed.
    """
    extras, options.extras = options.extras, []
    found: list[T] = []
    for feature, where, extra in extras:
        with faults_told(feature, f"its options `{where}`", complain, LumenError):
            found.append(call(extra))
            options.extras.append((feature, where, extra))
    return found
