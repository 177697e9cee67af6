"""Actions as closures over a workbench: compiled once, so that a step does not look at their kind again."""

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, TypeAlias

from lumen.interpreters.expressions import Scope, compile_expression, compile_guard, compile_template
from lumen.language.actions import (
    Action,
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
    Wait,
)
from lumen.language.commands import BodyCommand, Language, Log, Publish, Say, VerbCommand
from lumen.language.diagnostics import NodePath
from lumen.language.events import Event

if TYPE_CHECKING:
    from lumen.interpreters.statechart.execution_context import ExecutionContext

ActionFunction: TypeAlias = "Callable[[ExecutionContext], None]"
CompiledBlock: TypeAlias = "tuple[tuple[ActionFunction, NodePath], ...]"
CommandFactory: TypeAlias = "Callable[[ExecutionContext], BodyCommand]"


class ActionError(Exception):
    """An action can't be done as it is written; the rest of its block is skipped."""


def compile_block(steps: tuple[PlacedAction, ...]) -> CompiledBlock:
    """Each action with the place it stands at."""
    return tuple((compile_action(step.action), step.where) for step in steps)


def compile_action(action: Action) -> ActionFunction:
    """The doing of one action; it raises ExpressionError or ActionError where it fails."""
    match action:
        case Assign(values):
            return _assign(values)
        case Raise(event, data):
            body = compile_value(data)
            return lambda execution: execution.post(Event(event, body(execution.view()), execution.at))
        case Send(event, data, delay, id):
            body = compile_value(data)
            return lambda execution: execution.set_timer(id, delay, event, body(execution.view()))
        case CancelSend(id):
            return lambda execution: execution.cancel_send(id)
        case PublishBody(route, data):
            body = compile_value(data)
            return lambda execution: execution.emit(Publish(route, body(execution.view())))
        case LogText(template):
            text = compile_template(template.text)
            return lambda execution: execution.emit(Log(text(execution.view())))
        case If(guard, then, otherwise):
            return _if(guard, compile_block(then), compile_block(otherwise))
        case Wait() | Parallel():
            raise TypeError(f"{action} stands outside `do`")
    make = compile_command(action)

    def begin(execution: "ExecutionContext") -> None:
        execution.start(make(execution))

    return begin


def compile_command(action: SayText | VerbCommand) -> CommandFactory:
    """The command that a robot verb stands for."""
    match action:
        case SayText(texts):
            return _say(texts)
        case Language(language):

            def speak(execution: "ExecutionContext") -> BodyCommand:
                execution.language = language
                execution.scope = None
                return action

            return speak
        case _:
            return lambda execution: action


def compile_value(value: ComputedValue) -> Callable[[Scope], Any]:
    """What computes a value; lists and maps become JSON's."""
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


def _assign(values: Mapping[str, ComputedValue]) -> ActionFunction:
    pairs = [(key, compile_value(value)) for key, value in values.items()]

    def assign(execution: "ExecutionContext") -> None:
        before = execution.context
        try:
            for key, value in pairs:
                execution.store(key, value(execution.scope or execution.view()))
        except BaseException:
            execution.context, execution.scope = before, None
            raise

    return assign


def _if(guard: Expression, then: CompiledBlock, otherwise: CompiledBlock) -> ActionFunction:
    holds = compile_guard(guard.source)

    def choose(execution: "ExecutionContext") -> None:
        for act, _ in then if holds(execution.view()) else otherwise:
            act(execution)

    return choose


def _say(texts: Mapping[str, tuple[Any, ...]]) -> CommandFactory:
    spoken = {
        language: tuple(compile_template(template.text) for template in templates)
        for language, templates in texts.items()
    }
    fallback = "" if "" in spoken else next(iter(spoken))

    def say(execution: "ExecutionContext") -> BodyCommand:
        language = execution.language if execution.language in spoken else fallback
        alternatives = spoken[language]
        text = alternatives[execution.draw(len(alternatives))](execution.view())
        return Say(text, language or execution.language)

    return say
