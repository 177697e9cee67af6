"""`do` compiled: actions done one after another while a state is active, of which some take time."""

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
    """Done at once."""

    act: ActionFunction
    where: NodePath


@dataclass(frozen=True, slots=True)
class AwaitedCommand:
    """A robot's command, over when it is answered."""

    make: CommandFactory
    where: NodePath


@dataclass(frozen=True, slots=True)
class TimedWait:
    """Over after so many [s]."""

    seconds: float


@dataclass(frozen=True, slots=True)
class ConditionalAction:
    """`if`: one block or the other."""

    guard: Callable[[Scope], bool]
    then: "tuple[CompiledAction, ...]"
    otherwise: "tuple[CompiledAction, ...]"
    where: NodePath

    def block(self, name: str) -> "tuple[CompiledAction, ...]":
        return self.then if name == "then" else self.otherwise


@dataclass(frozen=True, slots=True)
class ParallelActions:
    """`parallel`: over with the last of its branches."""

    branches: "tuple[CompiledAction, ...]"


@dataclass(frozen=True, slots=True)
class AskedQuestion:
    """`ask`: over when its answer is said, or `otherwise` is done, which it is where none comes within so many [s]."""

    make: CommandFactory
    say: Callable[[ActionContext, Sentence], BodyCommand]
    within: float
    otherwise: "tuple[CompiledAction, ...]"
    where: NodePath


CompiledAction: TypeAlias = (
    InstantAction | AwaitedCommand | TimedWait | ConditionalAction | ParallelActions | AskedQuestion
)


def compile_do(steps: tuple[PlacedAction, ...]) -> tuple[CompiledAction, ...]:
    """The actions of a `do`, each with the place it stands at."""
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
