"""`python -m tests.fuzzy` prints how far the results of pyfuzzylite's own examples differ here."""

import sys

from tests.features.formats_fuzzy.test_fuzzylite import EXAMPLES, compared, example


def main() -> None:
    count, worst = 0, 0.0
    for file in EXAMPLES:
        _, _, controller, engine, points = example(file)
        off = [abs(mine - other) for mine, other in compared(controller, engine, points)]
        count, worst = count + len(off), max(worst, *off)
    sys.stdout.write(f"{len(EXAMPLES)} examples at 50 points each, {count:,} outputs: at most {worst:.1e} apart\n")


if __name__ == "__main__":
    main()
