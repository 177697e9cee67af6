"""`python -m tests.conformance`: run W3C's and SCION's cases of SCXML; print how many pass, and why each other fails.

The exit code is 0 if exactly the cases of `unsupported.yaml` fail, 1 if others do, 2 if the cases can't be fetched.
"""

import argparse
import sys
from collections.abc import Iterator, Sequence
from itertools import groupby

import pytest

from tests.conformance.cases import ADJUSTED, Outcome, cases, run, table

REASON = 110
"""Characters of a reason that are printed."""


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tests.conformance", description=__doc__)
    parser.add_argument("--only", default="", metavar="TEXT", help="run only the cases whose name contains this text")
    only = parser.parse_args().only
    try:
        found = [case for case in cases() if only in case.name]
    except (pytest.fail.Exception, pytest.skip.Exception) as error:
        sys.stderr.write(f"the cases can't be fetched: {error}\n")
        return 2
    outcomes = [run(case) for case in found if case.driver is not None]
    sys.stdout.write("\n".join(report(outcomes, len(found) - len(outcomes))) + "\n")
    known = {name for names in table()["unsupported"].values() for name in names}
    return int({o.case.name for o in outcomes if not o.passed} != {n for n in known if only in n})


def report(outcomes: Sequence[Outcome], without: int) -> Iterator[str]:
    """Yield the summary, the adjusted cases, and the failing ones by reason; `without` cases have no driver."""
    yield f"{'suite':8}{'cases':>8}{'pass as given':>16}{'pass adjusted':>16}{'fail':>8}"
    for suite in ("W3C", "SCION"):
        yield _row(suite, [o for o in outcomes if o.case.suite == suite])
    yield _row("both", outcomes)
    yield f"{without} more have no driver: other charts invoke them, or they need a person or a web server"
    for group, how in ADJUSTED.items():
        if names := [o.case.name for o in outcomes if o.adjusted == group]:
            yield f"\nadjusted: {', '.join(names)}\n    {how}"
    failed = sorted((o for o in outcomes if not o.passed), key=lambda o: (o.why[0], o.case.name))
    for reason, those in groupby(failed, key=lambda o: o.why[0]):
        names = [o.case.name for o in those]
        yield f"\n{len(names):4}  {reason if len(reason) <= REASON else reason[: REASON - 1] + '…'}"
        yield f"      {', '.join(names)}"


def _row(suite: str, outcomes: Sequence[Outcome]) -> str:
    given, passed = sum(o.as_given for o in outcomes), sum(o.passed for o in outcomes)
    return f"{suite:8}{len(outcomes):8}{given:16}{passed:16}{len(outcomes) - passed:8}"


if __name__ == "__main__":
    sys.exit(main())
