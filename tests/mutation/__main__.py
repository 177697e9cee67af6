"""`python -m tests.mutation`: mutants of the shipped project, and the verdicts of lint and the stories on them."""

import argparse
import sys
import time
from collections import Counter
from random import Random
from statistics import fmean
from typing import NamedTuple

from tests.mutation.judging import Judge, Outcome
from tests.mutation.mutants import SHIPPED, Mutant, Nursery

WELL = ("error found", "warned, and runs", "clean, and runs")


class Survey(NamedTuple):
    """The outcomes of mutants."""

    counts: Counter[tuple[str, str]]
    """The number of mutants by kind and outcome."""
    misses: list[tuple[Mutant, Outcome]]
    said: list[int]
    """The number of findings of each mutant that has one mistake and was reported."""

    @property
    def findings(self) -> float:
        """The average number of findings of one mistake."""
        return fmean(self.said)


def survey(seed: int, count: int, stories: int) -> Survey:
    judge, found = Judge(SHIPPED, stories), Survey(Counter(), [], [])
    for mutant in Nursery().mutants(seed, count):
        outcome = judge.judge(mutant.file, mutant.line, mutant.files, Random(mutant.number))
        found.counts[mutant.kind, outcome.what] += 1
        if outcome.what not in WELL:
            found.misses.append((mutant, outcome))
        elif mutant.mistakes == 1 and outcome.said:
            found.said.append(outcome.said)
    return found


def table(counts: Counter[tuple[str, str]]) -> str:
    """Return a table of the counts, with a row for each kind."""
    outcomes = [*WELL, *sorted({what for _, what in counts} - {*WELL})]
    kinds = sorted({kind for kind, _ in counts})
    rows = [("", *outcomes, "sum")]
    for kind in [*kinds, "all"]:
        numbers = [sum(n for (k, w), n in counts.items() if w == what and kind in (k, "all")) for what in outcomes]
        rows.append((kind, *map(str, numbers), str(sum(numbers))))
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    return "\n".join(
        "  ".join(c.rjust(w) if i else c.ljust(w) for i, (c, w) in enumerate(zip(r, widths, strict=True))) for r in rows
    )


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.mutation", description=__doc__)
    parser.add_argument("--count", type=int, default=1_000, help="how many mutants (default: 1,000)")
    parser.add_argument("--seed", type=int, default=0, help="the number of the first one (default: 0)")
    parser.add_argument("--stories", type=int, default=3, help="stories played with each that lint passes (default: 3)")
    options = parser.parse_args()
    began = time.process_time()
    found = survey(options.seed, options.count, options.stories)
    for mutant, outcome in found.misses:
        print(f"# {mutant.number} {mutant.kind}: {outcome.what}\n{mutant.difference}\n{outcome.trouble}")
    print(table(found.counts))
    print(f"{len(found.said):,} with one mistake: {found.findings:.2f} findings each, at most {max(found.said)}")
    taken = time.process_time() - began
    print(f"{found.counts.total():,} mutants, {len(found.misses)} misses, {taken:.0f} s of CPU")
    return int(bool(found.misses))


if __name__ == "__main__":
    sys.exit(main())
