"""A machine compiled, with those that it invokes."""

from collections.abc import Mapping
from typing import NamedTuple

from lumen.interpreters.statechart.chart import Chart
from lumen.interpreters.statechart.fast_path import FastPaths
from lumen.interpreters.statechart.plans import MicrostepPlanner
from lumen.language.machines import MachineDefinition


class CompiledMachine(NamedTuple):
    """A machine compiled; `invoked` are the programs of the behaviours that it invokes, by their names."""

    chart: Chart
    planner: MicrostepPlanner
    shortcuts: FastPaths
    invoked: "Mapping[str, CompiledMachine]"


def compiled(machine: MachineDefinition) -> CompiledMachine:
    """The machine's program, made on first use and kept beside it."""
    program: CompiledMachine | None = machine.__dict__.get("_program")
    if program is None:
        chart = Chart(machine)
        invoked = {name: compiled(other) for name, other in machine.invoked.items()}
        planner = MicrostepPlanner(chart)
        program = CompiledMachine(chart, planner, FastPaths(planner), invoked)
        object.__setattr__(machine, "_program", program)  # frozen, and the same for all who hold it
    return program
