"""A compiled machine together with those that it invokes."""

from collections.abc import Mapping
from typing import NamedTuple

from lumen.language.machines import MachineDefinition
from lumen.statechart.chart import Chart
from lumen.statechart.fast_path import FastPaths
from lumen.statechart.plans import MicrostepPlanner
from lumen.talk.hearing import hearing_of
from lumen.upkeep.garbage import gc_paused


class CompiledMachine(NamedTuple):
    """A machine, with those that it invokes, ready to run."""

    chart: Chart
    planner: MicrostepPlanner
    fast_paths: FastPaths
    invoked: "Mapping[str, CompiledMachine]"
    """The invoked behaviours, by name."""
    robots: tuple[str, ...] = ()
    """The names of other robots to which the machine can send events."""


def compiled(definition: MachineDefinition) -> CompiledMachine:
    """Return the compiled machine, which is made on first use and stored with the definition."""
    machine: CompiledMachine | None = definition.__dict__.get("_compiled")
    if machine is None:
        with gc_paused():  # nothing made here is garbage
            chart = Chart(definition)
            planner = MicrostepPlanner(chart)
            invoked = {name: compiled(other) for name, other in definition.invoked.items()}
            machine = CompiledMachine(chart, planner, FastPaths(planner), invoked, definition.robots)
        object.__setattr__(definition, "_compiled", machine)  # frozen, but all holders share it
    return machine


def prepare(definition: MachineDefinition) -> None:
    """Compile a machine and its phrases, so that the first sentence is processed without delay."""
    if any(t.hears for state in definition.states.values() for t in state.transitions):
        hearing_of(definition)
    for other in compiled(definition).chart.definition.invoked.values():
        prepare(other)
