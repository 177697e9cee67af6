"""`do`: actions performed one after another while a state is active, as a position that each answer moves on."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

from lumen.interpreters.expressions import ExpressionError, Scope, compile_guard
from lumen.interpreters.statechart.blocks import (
    ActionError,
    ActionFunction,
    CommandFactory,
    compile_action,
    compile_command,
)
from lumen.interpreters.statechart.values import Awaiting, Fork, Position, Within
from lumen.language.actions import (
    Action,
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
from lumen.language.diagnostics import NodePath

if TYPE_CHECKING:
    from lumen.interpreters.statechart.execution_context import ExecutionContext


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


CompiledAction: TypeAlias = InstantAction | AwaitedCommand | TimedWait | ConditionalAction | ParallelActions


class ActivityError(Exception):
    """A action failed; carries the place and the reason."""

    def __init__(self, reason: str, where: NodePath) -> None:
        super().__init__(reason)
        self.reason, self.where = reason, where


def compile_do(steps: tuple[PlacedAction, ...]) -> tuple[CompiledAction, ...]:
    """The actions of a `do`."""
    return tuple(_compile(step.action, step.where) for step in steps)


def begin_block(
    execution: "ExecutionContext", actions: tuple[CompiledAction, ...], name: Any = "do", index: int = 0
) -> Within | None:
    """Do everything from `index` on that takes no time; where it stands then, None at its end."""
    for place in range(index, len(actions)):
        inner = _begin(execution, actions[place])
        if inner is not None:
            return Within(name, place, inner)
    return None


def resume(
    execution: "ExecutionContext", actions: tuple[CompiledAction, ...], position: Within, id: str
) -> Within | None:
    """Go on from `position` now that what it awaited under `id` is over."""
    inner = _resume(execution, actions[position.place], position.inner, id)
    if inner is not None:
        return position._replace(inner=inner)
    return begin_block(execution, actions, position.block, position.place + 1)


def awaited(position: Position | None) -> Iterator[str]:
    """The ids that a position awaits."""
    match position:
        case Awaiting(id):
            yield id
        case Within(_, _, inner):
            yield from awaited(inner)
        case Fork(branches):
            for branch in branches:
                yield from awaited(branch)


def _begin(execution: "ExecutionContext", action: CompiledAction) -> Position | None:
    match action:
        case InstantAction(act, where):
            with _Failing(where):
                act(execution)
            return None
        case AwaitedCommand(make, where):
            with _Failing(where):
                return Awaiting(execution.start(make(execution), awaited=True))
        case TimedWait(seconds):
            return Awaiting(execution.set_wait(seconds))
        case ConditionalAction(guard, then, otherwise, where):
            with _Failing(where):
                holds = guard(execution.view())
            return begin_block(execution, then if holds else otherwise, "then" if holds else "else")
        case ParallelActions(branches):
            return _fork([_begin(execution, branch) for branch in branches])
    raise AssertionError(action)


def _resume(execution: "ExecutionContext", action: CompiledAction, position: Position, id: str) -> Position | None:
    match action, position:
        case ConditionalAction(), Within(block, _, _):
            return resume(execution, action.block(block), position, id)
        case ParallelActions(branches), Fork(positions):
            return _fork(
                [_move(execution, branch, place, id) for branch, place in zip(branches, positions, strict=True)]
            )
    return None


def _move(execution: "ExecutionContext", action: CompiledAction, position: Position | None, id: str) -> Position | None:
    return _resume(execution, action, position, id) if position is not None and id in awaited(position) else position


def _fork(branches: list[Position | None]) -> Fork | None:
    return Fork(tuple(branches)) if any(branch is not None for branch in branches) else None


class _Failing:
    """Turns what an expression or action raises into a DeedError with its place."""

    def __init__(self, where: NodePath) -> None:
        self.where = where

    def __enter__(self) -> None: ...

    def __exit__(self, kind: object, error: BaseException | None, trace: object) -> None:
        if isinstance(error, ExpressionError | ActionError):
            raise ActivityError(str(error), self.where) from error


def _compile(action: Action, where: NodePath) -> CompiledAction:
    match action:
        case Wait(seconds):
            return TimedWait(seconds)
        case Parallel(branches):
            return ParallelActions(compile_do(branches))
        case If(guard, then, otherwise):
            return ConditionalAction(compile_guard(guard.source), compile_do(then), compile_do(otherwise), guard.where)
        case Assign() | Raise() | Send() | CancelSend() | PublishBody() | LogText():
            return InstantAction(compile_action(action), where)
    return AwaitedCommand(compile_command(action), where)
