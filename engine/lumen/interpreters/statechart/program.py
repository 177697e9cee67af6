"""A machine compiled, with those that it invokes."""

from collections.abc import Mapping
from typing import NamedTuple

from lumen.interpreters.statechart.chart import Chart
from lumen.interpreters.statechart.plans import Planner
from lumen.interpreters.statechart.shortcuts import Shortcuts
from lumen.language.machines import Machine


class Program(NamedTuple):
    """A machine compiled; `invoked` are the programs of the behaviours that it invokes, by their names."""

    chart: Chart
    planner: Planner
    shortcuts: Shortcuts
    invoked: "Mapping[str, Program]"


def compiled(machine: Machine) -> Program:
    """The machine's program, made on first use and kept beside it."""
    program: Program | None = machine.__dict__.get("_program")
    if program is None:
        chart = Chart(machine)
        invoked = {name: compiled(other) for name, other in machine.invoked.items()}
        planner = Planner(chart)
        program = Program(chart, planner, Shortcuts(planner), invoked)
        object.__setattr__(machine, "_program", program)  # frozen, and the same for all who hold it
    return program
