"""`python -m tests.statechart.oracle [MACHINES]` compares so many random machines, and counts those that differ."""

import sys
from collections import Counter

from hypothesis import Phase, given, seed, settings

from lumen.language.machines import MachineDefinition, StateKind
from tests.statechart.oracle.generating import Event as Happening
from tests.statechart.oracle.generating import happenings, machines
from tests.statechart.oracle.test_oracle import BUSY, compare

HUNDRED = 100


def main() -> None:
    wanted = int(sys.argv[1]) if len(sys.argv) > 1 else 3_000
    tally: Counter[str] = Counter()
    for block in range(-(-wanted // HUNDRED)):

        @seed(block)
        @settings(BUSY, max_examples=HUNDRED, phases=[Phase.generate])
        @given(machines(), happenings)
        def everyone(machine: MachineDefinition, events: list[Happening | None]) -> None:
            try:
                compare(machine, events, tally)
            except AssertionError:
                tally["machines that differ"] += 1
            shape(machine, tally)

        everyone()
    for what, count in sorted(tally.items()):
        sys.stdout.write(f"{count:9,}  {what}\n")


def shape(machine: MachineDefinition, tally: Counter[str]) -> None:
    """Count the parts of the machine that concern ends and completion."""
    states = machine.states.values()
    kinds = [(s.kind, machine.states[s.parent].kind) for s in states if s.parent is not None]
    tally["machines with a parallel state in a parallel state"] += (StateKind.PARALLEL, StateKind.PARALLEL) in kinds
    tally["machines with a final state as a region"] += (StateKind.FINAL, StateKind.PARALLEL) in kinds


if __name__ == "__main__":
    main()
