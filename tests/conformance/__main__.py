"""`python -m tests.conformance` counts the cases that pass, and the others by their reasons."""

import sys

from tests.conformance.cases import cases, table


def main() -> None:
    found, known = cases(), table()
    rows = [(len(names), reason) for reason, names in known["unsupported"].items()]
    rest = sum(number for number, _ in rows)
    drivers = sum(case.driver is not None for case in found)
    lines = [f"{drivers - rest} of {drivers} cases with a driver pass; {len(found) - drivers} have none"]
    lines += [f"{number:4}  {reason}" for number, reason in sorted(rows, reverse=True)]
    sys.stdout.write("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
