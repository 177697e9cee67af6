"""The options of `lumen lint --physics`, and its printed summary."""

import argparse
from collections.abc import Sequence

from lumen.cli.streams import complain
from lumen.cli.workers_option import configure_workers
from lumen.errors import UsageError
from lumen.features.simulation.options import configure_imperfections, imperfections_of
from lumen.run.linting.findings import Findings
from lumen.run.linting.targets import Wanted

ONLY_WITH = ("robots", "workers", "imperfections")
"""Options that need `--physics`."""


class PhysicsOptions:
    """`--physics` and the options that need it."""

    def configure(self, parser: argparse.ArgumentParser) -> None:
        """Add the options to the parser."""
        add = parser.add_argument
        add(
            "--physics",
            action="store_true",
            help="also play every motion in simulation (takes minutes; results are kept)",
        )
        add(
            "--robots",
            metavar="N",
            help="with --physics: also play each motion on N slightly different robots (default: 20)",
        )
        configure_workers(parser, "with --physics: ")
        configure_imperfections(parser)

    def check(self, options: argparse.Namespace) -> None:
        """Raise UsageError for options that need `--physics` or can't be combined with it."""
        for name in ONLY_WITH:
            if vars(options)[name] is not None and not options.physics:
                raise UsageError(f"--{name} needs --physics")
        if options.physics and (options.watch or options.fix or options.diff or "-" in options.paths):
            raise UsageError("--physics can't be combined with --watch, --fix, --diff or `-`")

    def more(self, found: Sequence[Findings], wanted: Wanted, options: argparse.Namespace) -> list[Findings]:
        """Return the findings, with `--physics` including those of the simulated motions.

        With `--format text`, also print a summary of the simulations. Raises UsageError for an invalid option.
        """
        if not options.physics:
            return [*found]
        from lumen.cli.progress import progress
        from lumen.features.simulation.trials.playing import ROBOTS, number_of_robots, played, summary
        from lumen.run.workers.workers import workers_of

        robots = ROBOTS if options.robots is None else number_of_robots(options.robots)
        workers, lacking = workers_of(options.workers), imperfections_of(options.imperfections)
        with progress() as tell:
            both = [played(each, wanted, robots, tell, imperfections=lacking, workers=workers) for each in found]
        for _, rehearsals in both if options.format == "text" else ():
            complain(summary(rehearsals) or "no motion was played: the project has none, or its files have errors")
        return [each for each, _ in both]
