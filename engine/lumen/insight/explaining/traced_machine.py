"""Compiles a machine whose actions record their paths while they run, for steps that are taken again."""

from typing import Any

from lumen.expressions import compile_guard
from lumen.language.actions import Action, AskQuestion, If, Parallel, PlacedAction
from lumen.language.diagnostics import NodePath
from lumen.language.machines import MachineDefinition
from lumen.statechart.asking import compile_question, spoken
from lumen.statechart.blocks import ActionFunction, CommandFactory, CompiledBlock, compile_action
from lumen.statechart.chart import Chart
from lumen.statechart.compiled_machine import CompiledMachine
from lumen.statechart.do_actions import (
    AskedQuestion,
    AwaitedCommand,
    CompiledAction,
    ConditionalAction,
    InstantAction,
    ParallelActions,
    TimedWait,
    compile_do,
)
from lumen.statechart.fast_path import FastPaths
from lumen.statechart.plans import MicrostepPlanner


def traced(definition: MachineDefinition) -> CompiledMachine:
    """Return the machine compiled for tracing; the definition keeps it for the next call."""
    machine: CompiledMachine | None = definition.__dict__.get("_traced")
    if machine is None:
        chart = Chart(definition)
        for node in chart.nodes.values():
            state = definition.states[node.path]
            node.entry, node.exit, node.do = _block(state.entry), _block(state.exit), _do(state.do)
            for transition in node.transitions:
                transition.block = _block(transition.definition.actions)
        planner = MicrostepPlanner(chart)
        invoked = {name: traced(other) for name, other in definition.invoked.items()}
        machine = CompiledMachine(chart, planner, FastPaths(planner), invoked)
        object.__setattr__(definition, "_traced", machine)  # frozen, but all holders share it
    return machine


def _block(steps: tuple[PlacedAction, ...]) -> CompiledBlock:
    return tuple((_placed(step.where, _action(step.action)), step.where) for step in steps)


def _action(action: Action) -> ActionFunction:
    if not isinstance(action, If):
        return compile_action(action)
    holds, then, otherwise = compile_guard(action.guard.source), _block(action.then), _block(action.otherwise)

    def choose(context: Any) -> None:
        for act, _ in then if holds(context.scope()) else otherwise:
            act(context)

    return choose


def _placed(where: NodePath, act: ActionFunction) -> ActionFunction:
    def acting(context: Any) -> None:
        around, context.acting = context.acting, where
        try:
            act(context)
        finally:
            context.acting = around

    return acting


def _do(steps: tuple[PlacedAction, ...]) -> tuple[CompiledAction, ...]:
    return tuple(_deed(step.action, step) for step in steps)


def _deed(action: Action, step: PlacedAction) -> CompiledAction:
    match action:
        case If(guard, then, otherwise):
            return ConditionalAction(compile_guard(guard.source), _do(then), _do(otherwise), guard.where)
        case Parallel(branches):
            return ParallelActions(_do(branches))
        case AskQuestion(_, within, otherwise):
            question = compile_question(action)
            make = _making(step.where, lambda context: question(context.scope()))
            return AskedQuestion(make, _saying(step.where), within, _do(otherwise), step.where)
    match compile_do((step,))[0]:
        case InstantAction(act, where):
            return InstantAction(_placed(where, act), where)
        case AwaitedCommand(make, where):
            return AwaitedCommand(_making(where, make), where)
        case TimedWait() as wait:
            return wait
        case other:
            raise AssertionError(other)


def _making(where: NodePath, make: CommandFactory) -> CommandFactory:
    def making(context: Any) -> Any:
        context.acting = where  # the path stays until the command has started
        return make(context)

    return making


def _saying(where: NodePath) -> Any:
    def saying(context: Any, sentence: Any) -> Any:
        context.acting = where
        return spoken(context, sentence)

    return saying
