"""`python -m tests.attack`: random files, messages and frames against running exhibitions, which must survive them.

Attack N is the same on every machine and in every run: `--only N` makes it alone. After each batch an exhibition must
still tick, obey a stop, speak and answer a status request; its memory, threads and handles must not grow.

`python -m tests.attack --imports 2000` changes files of other tools, one name or value at a time, and imports them: the
result or the findings must differ, unless the format's table lists the changed name as without meaning.
"""

import argparse
import itertools
import logging
import os
import platform
import sys
import time
from collections.abc import Iterable, Sequence
from pathlib import Path

from tests.attack.running import Survey, grown, survey
from tests.attack.silence import attack_imports, show
from tests.rabbitmq import RabbitMQ


def table(found: list[Survey]) -> str:
    """Return a table with a row for each lane, and beneath it the number of attacks with each outcome."""
    names = ("attacks", "checks", "seconds", "a second", "memory", "threads", "handles")
    lines = [f"{'way in':<9}" + "".join(name.rjust(11) for name in names)]
    for one in found:
        more, rate = one.growth, one.count / one.seconds
        numbers = (f"{one.count:,}", f"{one.checks}", f"{one.seconds:.0f}", f"{rate:.1f}", f"{more.memory:+.1f} MB")
        lines.append(
            f"{one.name:<9}" + "".join(f"{n:>11}" for n in (*numbers, f"{more.threads:+}", f"{more.handles:+}"))
        )
        lines.append(" " * 9 + ", ".join(f"{count:,} {what}" for what, count in one.outcomes.most_common()))
    return "\n".join(lines)


def named(numbers: list[int]) -> str:
    """Return a phrase for the attacks that together broke a target."""
    if len(numbers) > 10:
        return f"{len(numbers)} attacks from {numbers[0]} to {numbers[-1]} together"
    return f"attack {', '.join(map(str, numbers))}"


def report(numbers: Iterable[int], url: str) -> list[str]:
    """Run these attacks and print a table; return a line for each fault, and for each resource that grew."""
    began = time.monotonic()
    found = survey(numbers, url)
    print(f"\n{platform.machine()}, {os.cpu_count()} cores, CPython {platform.python_version()}, recording robot\n")
    print(table(found))
    troubles = [f"{named(t.numbers)}: {t.text}" for one in found for t in one.troubles]
    troubles += [line for one in found for line in grown(one)]
    count = sum(one.count for one in found)
    print(f"\n{count:,} attacks, {len(troubles)} troubles, {time.monotonic() - began:.0f} s")
    return troubles


def report_imports(numbers: Iterable[int], folders: Sequence[Path], most: int) -> list[str]:
    """Import these changed files and print the outcomes; return the changes that were lost silently."""
    logging.getLogger("lumen").setLevel(logging.CRITICAL)
    began = time.process_time()
    found = attack_imports(numbers, folders, most=most)
    for ending, count in sorted(found.tried.items()):
        print(f".{ending:<7}{count:>7,}")
    count = sum(found.tried.values())
    outcomes = ", ".join(f"{count:,} {what}" for what, count in found.outcomes.most_common())
    seconds = time.process_time() - began
    print(f"\n{count:,} changes ({outcomes}), {len(found.troubles)} troubles, {seconds:.0f} s of processor time")
    return [f"change {trouble.number}, {trouble.sample}: {trouble.text}" for trouble in found.troubles]


def main() -> int:
    parser = argparse.ArgumentParser(
        prog="python -m tests.attack", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--count", type=int, default=1_000, help="how many attacks (default: 1,000)")
    parser.add_argument("--seed", type=int, default=0, help="the number of the first one (default: 0)")
    parser.add_argument("--only", type=int, metavar="N", help="make attack N alone")
    parser.add_argument("--imports", type=int, metavar="N", help="make N changes to files for `lumen import` instead")
    parser.add_argument(
        "--samples", type=Path, action="append", default=[], metavar="DIR", help="with --imports: more files to change"
    )
    options = parser.parse_args()
    if options.imports is not None:
        if options.only is not None:
            print(show(options.only, options.samples))
        alone = None if options.only is None else [options.only]
        troubles = report_imports(alone or itertools.count(options.seed), options.samples, options.imports)
        for trouble in troubles:
            print(f"\n# {trouble}")
        return int(bool(troubles))
    logging.getLogger("lumen").setLevel(logging.CRITICAL)  # of our own bus, which hears the same
    broker = RabbitMQ()
    broker.start()
    try:
        numbers = range(options.seed, options.seed + options.count) if options.only is None else [options.only]
        troubles = report(numbers, broker.url)
    finally:
        broker.stop()
    for trouble in troubles:
        print(f"\n# {trouble}")
    return int(bool(troubles))


if __name__ == "__main__":
    sys.exit(main())
