"""Every action and every expression of a behaviour, with its place."""

from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from lumen.expressions import schema_of
from lumen.language.actions import (
    AskQuestion,
    Assign,
    ComputedValue,
    Expression,
    If,
    LogText,
    PlacedAction,
    PublishBody,
    Raise,
    SayText,
    Send,
    Template,
    nested,
)
from lumen.language.added_verbs import is_template, texts_in
from lumen.language.commands import Do, GoTo
from lumen.language.diagnostics import NodePath
from lumen.language.machines import Invoke, MachineDefinition, State, Transition
from lumen.language.properties import conditions_of
from lumen.project.memoization import Same, memoize


class ActionSite(NamedTuple):
    """An action in its state."""

    state: State
    transition: Transition | None
    """The transition of the action; None for `entry`, `do` and `exit`."""
    step: PlacedAction


class ExpressionSite(NamedTuple):
    """An expression or template."""

    text: Expression | Template
    """The expression, with its place."""
    transition: Transition | None
    """The transition to which the expression belongs; None for any other part of a state."""
    guard: bool = False
    """Whether the expression is a condition."""
    key: str = ""
    """The context key to which `assign` assigns the expression's value; empty for other expressions."""
    expected: Mapping[str, Any] | None = None
    """The JSON Schema that the expression's value must fit, if neither `guard` nor `key` implies one."""


def action_sites(machine: MachineDefinition) -> tuple[ActionSite, ...]:
    """Return all actions, including those inside `if` and `parallel`, in the order of the file."""
    return memoize(("action sites", machine.id), Same(machine), lambda: tuple(_actions(machine)))


def expression_sites(machine: MachineDefinition) -> tuple[ExpressionSite, ...]:
    """Return all expressions and templates."""
    return memoize(("expression sites", machine.id), Same(machine), lambda: tuple(_expressions(machine)))


def _actions(machine: MachineDefinition) -> Iterator[ActionSite]:
    for state in machine.states.values():
        for block in (state.entry, state.do, state.exit):
            yield from (ActionSite(state, None, step) for step in nested(block) if not _made(step.where))
        for transition in state.transitions:
            steps = (step for step in nested(transition.actions) if not _made(step.where))
            yield from (ActionSite(state, transition, step) for step in steps)


def _expressions(machine: MachineDefinition) -> Iterator[ExpressionSite]:
    for state in machine.states.values():
        yield from (ExpressionSite(text, None) for text in _values(state.output))
        for invoke in state.invoke:
            yield from _input(invoke, machine.invoked.get(invoke.behavior))
        if state.for_each:
            yield ExpressionSite(state.for_each.each, None, expected={"type": "array"})
        delays = {t.event: t.delay for t in state.transitions if isinstance(t.delay, Template)}
        yield from (ExpressionSite(delay, None) for delay in delays.values())
        for transition in state.transitions:
            if transition.guard and not _made(transition.guard.where):
                yield ExpressionSite(transition.guard, transition, guard=True)
    for site in action_sites(machine):
        yield from _spots(site)
    yield from (ExpressionSite(condition, None, guard=True) for condition in conditions_of(machine.properties))


def _made(where: NodePath) -> bool:
    """Return whether an element was generated from a `for`: it has the path of the `for` and is not in the file."""
    return where[-1:] == ("for",)


def _input(invoke: Invoke, machine: MachineDefinition | None) -> Iterator[ExpressionSite]:
    for key, value in invoke.input.items():
        if isinstance(value, Expression) and machine and key in machine.context:
            yield ExpressionSite(value, None, expected=machine.types.get(key, schema_of(machine.context[key])))
        else:
            yield from (ExpressionSite(text, None) for text in _values(value))


def _spots(site: ActionSite) -> Iterator[ExpressionSite]:
    transition = site.transition
    match site.step.action:
        case If(guard=guard):
            yield ExpressionSite(guard, transition, guard=True)
        case AskQuestion(question=question):
            yield ExpressionSite(question, transition, expected={"type": "string"})
        case Assign(values):
            for key, value in values.items():
                if isinstance(value, Expression):
                    yield ExpressionSite(value, transition, key=key)
                else:
                    yield from (ExpressionSite(text, transition) for text in _values(value))
        case SayText(texts):
            yield from (ExpressionSite(text, transition) for said in texts.values() for text in said)
        case LogText(text):
            yield ExpressionSite(text, transition)
        case GoTo(to):
            yield ExpressionSite(Template(to, (*site.step.where, "walk", "to")), transition)
        case Do(skill, arguments) if is_template(site.step.action):
            for place, filled in texts_in(arguments, (*site.step.where, skill)):
                if "{{" in filled:
                    yield ExpressionSite(Template(filled, place), transition)
        case Send(data=value, delay=Template() as delay):
            yield ExpressionSite(delay, transition)
            yield from (ExpressionSite(text, transition) for text in _values(value))
        case PublishBody(body=value) | Raise(data=value) | Send(data=value):
            yield from (ExpressionSite(text, transition) for text in _values(value))


def _values(value: ComputedValue) -> Iterator[Expression]:
    if isinstance(value, Expression):
        yield value
    elif isinstance(value, Mapping):
        for item in value.values():
            yield from _values(item)
    elif isinstance(value, tuple):
        for item in value:
            yield from _values(item)
