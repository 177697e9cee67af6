"""Compiled `do` blocks: actions executed in sequence while a state is active; some of them take time."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

from lumen.expressions import Scope, compile_guard
from lumen.language.actions import (
    Action,
    AskQuestion,
    Assign,
    CancelSend,
    If,
    LogText,
    Parallel,
    PlacedAction,
    PublishBody,
    Raise,
    Send,
    Wait,
)
from lumen.language.commands import BodyCommand
from lumen.language.diagnostics import NodePath
from lumen.statechart.action_context import ActionContext
from lumen.statechart.asking import Sentence, compile_question, spoken
from lumen.statechart.blocks import ActionFunction, CommandFactory, compile_action, compile_command


@dataclass(frozen=True, slots=True)
class InstantAction:
    """An action that ends at once."""

    act: ActionFunction
    where: NodePath


@dataclass(frozen=True, slots=True)
class AwaitedCommand:
    """A command of the robot; it ends when the robot answers."""

    make: CommandFactory
    where: NodePath


@dataclass(frozen=True, slots=True)
class TimedWait:
    """A pause of `seconds` [s]."""

    seconds: float


@dataclass(frozen=True, slots=True)
class ConditionalAction:
    """An `if` with its two blocks."""

    guard: Callable[[Scope], bool]
    then: "tuple[CompiledAction, ...]"
    otherwise: "tuple[CompiledAction, ...]"
    where: NodePath

    def block(self, name: str) -> "tuple[CompiledAction, ...]":
        """Return the block of that name: `then` or `else`."""
        return self.then if name == "then" else self.otherwise


@dataclass(frozen=True, slots=True)
class ParallelActions:
    """A `parallel`; it ends with the last of its branches."""

    branches: "tuple[CompiledAction, ...]"


@dataclass(frozen=True, slots=True)
class AskedQuestion:
    """An `ask`; it ends when its answer has been said, or with `otherwise`."""

    make: CommandFactory
    """Makes the command that asks the question."""
    say: Callable[[ActionContext, Sentence], BodyCommand]
    """Makes the command that says a sentence of the answer."""
    within: float
    """The time limit for the answer [s]."""
    otherwise: "tuple[CompiledAction, ...]"
    """The actions that run if no answer comes in time."""
    where: NodePath


CompiledAction: TypeAlias = (
    InstantAction | AwaitedCommand | TimedWait | ConditionalAction | ParallelActions | AskedQuestion
)


def compile_do(steps: tuple[PlacedAction, ...]) -> tuple[CompiledAction, ...]:
    """Compile the actions of a `do`, each with its place in the YAML."""
    return tuple(_compile(step.action, step.where) for step in steps)


def _compile(action: Action, where: NodePath) -> CompiledAction:
    match action:
        case Wait(seconds):
            return TimedWait(seconds)
        case Parallel(branches):
            return ParallelActions(compile_do(branches))
        case If(guard, then, otherwise):
            return ConditionalAction(compile_guard(guard.source), compile_do(then), compile_do(otherwise), guard.where)
        case AskQuestion(_, within, otherwise):
            question = compile_question(action)
            return AskedQuestion(
                lambda context: question(context.scope()), spoken, within, compile_do(otherwise), where
            )
        case Assign() | Raise() | Send() | CancelSend() | PublishBody() | LogText():
            return InstantAction(compile_action(action), where)
    return AwaitedCommand(compile_command(action), where)
