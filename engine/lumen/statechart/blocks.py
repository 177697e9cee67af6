"""Actions compiled to functions of a context, so that a step need not examine their kinds again."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Any, TypeAlias

from lumen.expressions import Scope, compile_expression, compile_guard, compile_template
from lumen.language.actions import (
    Action,
    AskQuestion,
    Assign,
    CancelSend,
    ComputedValue,
    Expression,
    If,
    LogText,
    Parallel,
    PlacedAction,
    PublishBody,
    Raise,
    SayText,
    Send,
    Template,
    Wait,
)
from lumen.language.added_verbs import is_template, with_texts
from lumen.language.commands import BodyCommand, Do, GoTo, Language, Log, Publish, Say, SaysGestures, VerbCommand
from lumen.language.diagnostics import NodePath
from lumen.language.durations import seconds
from lumen.language.events import Event
from lumen.statechart.action_context import ActionContext, ActionError
from lumen.statechart.nested_values import with_value

ActionFunction: TypeAlias = Callable[[ActionContext], None]
CompiledBlock: TypeAlias = tuple[tuple[ActionFunction, NodePath], ...]
CommandFactory: TypeAlias = Callable[[ActionContext], BodyCommand]
Alternatives: TypeAlias = tuple[str, tuple[Callable[[Scope], str], ...]]
"""A language, and the alternative texts in it."""


def compile_block(steps: tuple[PlacedAction, ...]) -> CompiledBlock:
    """Compile each action; return the functions with the places of the actions in the YAML."""
    return tuple((compile_action(step.action), step.where) for step in steps)


def compile_action(action: Action) -> ActionFunction:
    """Return a function that executes one action; it raises ExpressionError or ActionError on failure."""
    match action:
        case Assign(values):
            return _assign(values)
        case Raise(event, data):
            body = compile_value(data)
            return lambda context: context.raise_event(Event(event, body(context.scope()), context.at))
        case Send(event, data, delay, id, to):
            body, length = compile_value(data), compile_delay(delay)
            return lambda context: context.send(id, length(context), event, body(context.scope()), to)
        case CancelSend(id):
            return lambda context: context.cancel_send(id)
        case PublishBody(route, data):
            body = compile_value(data)
            return lambda context: context.emit(Publish(route, body(context.scope())))
        case LogText(template):
            text = compile_template(template.text)
            return lambda context: context.emit(Log(text(context.scope())))
        case If(guard, then, otherwise):
            return _if(guard, compile_block(then), compile_block(otherwise))
        case Wait() | Parallel() | AskQuestion():
            raise TypeError(f"{action} is outside `do`")
    make = compile_command(action)

    def begin(context: ActionContext) -> None:
        context.start(make(context))

    return begin


def compile_command(action: SayText | VerbCommand) -> CommandFactory:
    """Return a function that makes the command of a robot verb."""
    match action:
        case SayText(texts, gestures):
            return _say(texts, gestures)
        case Language(language):

            def speak(context: ActionContext) -> BodyCommand:
                context.language = language
                context.cached_scope = None
                return action

            return speak
        case GoTo(to) if "{{" in to:
            place = compile_template(to)
            return lambda context: GoTo(place(context.scope()))
        case Do() if is_template(action):
            return _do(action)
        case _:
            return lambda context: action


def compile_value(value: ComputedValue) -> Callable[[Scope], Any]:
    """Return a function that computes a value; lists and maps become JSON lists and maps."""
    match value:
        case Expression(source):
            return compile_expression(source)
        case tuple():
            items = [compile_value(item) for item in value]
            return lambda scope: [item(scope) for item in items]
        case Mapping():
            pairs = {key: compile_value(item) for key, item in value.items()}
            return lambda scope: {key: item(scope) for key, item in pairs.items()}
        case _:
            return lambda scope: value


def compile_assignment(way: str, value: ComputedValue) -> tuple[str, Callable[[Scope], Any]]:
    """Return the context key that an entry of `assign` changes, and a function that computes its new value.

    For a path into a map, such as `a.b`, the value is a copy of the map with the value at the end of the path; the
    function raises ExpressionError if a value on the path is not a map.
    """
    compute = compile_value(value)
    key, *within = way.split(".")
    if not within:
        return key, compute
    return key, lambda scope: with_value(scope.context[key], key, within, compute(scope))


def compile_delay(delay: float | Template) -> Callable[[ActionContext], float]:
    """Return a function that computes a delay [s]; it raises ActionError if a template gives no duration."""
    if not isinstance(delay, Template):
        return lambda context: delay
    text = compile_template(delay.text)

    def length(context: ActionContext) -> float:
        said = text(context.scope())
        if (found := seconds(said)) is None:
            raise ActionError(f"the delay `{said}` is not a duration: write a number and its unit, such as `20s`")
        return found

    return length


def _assign(values: Mapping[str, ComputedValue]) -> ActionFunction:
    pairs = [compile_assignment(way, value) for way, value in values.items()]

    def assign(context: ActionContext) -> None:
        before = context.data
        try:
            for key, value in pairs:
                context.assign(key, value(context.cached_scope or context.scope()))
        except BaseException:
            context.data, context.cached_scope = before, None
            raise

    return assign


def _if(guard: Expression, then: CompiledBlock, otherwise: CompiledBlock) -> ActionFunction:
    holds = compile_guard(guard.source)

    def choose(context: ActionContext) -> None:
        for act, _ in then if holds(context.scope()) else otherwise:
            act(context)

    return choose


def _say(texts: Mapping[str, tuple[Template, ...]], gestures: SaysGestures) -> CommandFactory:
    alternatives_in = alternatives(texts)

    def say(context: ActionContext) -> BodyCommand:
        said, templates = alternatives_in(context.language)
        text = templates[context.draw(len(templates))](context.scope())
        return Say(text, said, gestures)

    return say


def _do(command: Do) -> CommandFactory:
    def do(context: ActionContext) -> BodyCommand:
        scope = context.scope()
        return replace(command, arguments=with_texts(command.arguments, lambda text, _: compile_template(text)(scope)))

    return do


def alternatives(texts: Mapping[str, tuple[Template, ...]]) -> Callable[[str], Alternatives]:
    """Return a function from a wanted language to the language used and its texts.

    Without texts in the wanted language it falls back to those for every language, else to the first language.
    """
    spoken = {
        language: tuple(compile_template(template.text) for template in templates)
        for language, templates in texts.items()
    }
    fallback = "" if "" in spoken else next(iter(spoken))

    def alternatives_in(wanted: str) -> Alternatives:
        language = wanted if wanted in spoken else fallback
        return language or wanted, spoken[language]

    return alternatives_in
