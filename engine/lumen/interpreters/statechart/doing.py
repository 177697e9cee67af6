"""`do`: actions performed one after another while a state is active, as a position that each answer moves on."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, TypeAlias

from lumen.interpreters.expressions import ExpressionError, Scope, compile_guard
from lumen.interpreters.statechart.blocks import Act, ActionError, Make, compile_action, compile_command
from lumen.interpreters.statechart.values import Awaiting, Fork, Position, Within
from lumen.language.actions import (
    Action,
    Assign,
    CancelSend,
    If,
    LogText,
    Parallel,
    PublishBody,
    Raise,
    Send,
    Step,
    Wait,
)
from lumen.language.diagnostics import NodePath

if TYPE_CHECKING:
    from lumen.interpreters.statechart.workbench import Workbench


@dataclass(frozen=True, slots=True)
class Instant:
    """Done at once."""

    act: Act
    where: NodePath


@dataclass(frozen=True, slots=True)
class Awaited:
    """A robot's command, over when it is answered."""

    make: Make
    where: NodePath


@dataclass(frozen=True, slots=True)
class Pause:
    """Over after so many [s]."""

    seconds: float


@dataclass(frozen=True, slots=True)
class Choice:
    """`if`: one block or the other."""

    guard: Callable[[Scope], bool]
    then: "tuple[Deed, ...]"
    otherwise: "tuple[Deed, ...]"
    where: NodePath

    def block(self, name: str) -> "tuple[Deed, ...]":
        return self.then if name == "then" else self.otherwise


@dataclass(frozen=True, slots=True)
class Together:
    """`parallel`: over with the last of its branches."""

    branches: "tuple[Deed, ...]"


Deed: TypeAlias = Instant | Awaited | Pause | Choice | Together


class DeedError(Exception):
    """A deed failed; carries the place and the reason."""

    def __init__(self, reason: str, where: NodePath) -> None:
        super().__init__(reason)
        self.reason, self.where = reason, where


def compile_do(steps: tuple[Step, ...]) -> tuple[Deed, ...]:
    """The deeds of a `do`."""
    return tuple(_compile(step.action, step.where) for step in steps)


def begin_block(bench: "Workbench", deeds: tuple[Deed, ...], name: Any = "do", index: int = 0) -> Within | None:
    """Do everything from `index` on that takes no time; where it stands then, None at its end."""
    for place in range(index, len(deeds)):
        inner = _begin(bench, deeds[place])
        if inner is not None:
            return Within(name, place, inner)
    return None


def resume(bench: "Workbench", deeds: tuple[Deed, ...], position: Within, id: str) -> Within | None:
    """Go on from `position` now that what it awaited under `id` is over."""
    inner = _resume(bench, deeds[position.place], position.inner, id)
    if inner is not None:
        return position._replace(inner=inner)
    return begin_block(bench, deeds, position.block, position.place + 1)


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


def _begin(bench: "Workbench", deed: Deed) -> Position | None:
    match deed:
        case Instant(act, where):
            with _Failing(where):
                act(bench)
            return None
        case Awaited(make, where):
            with _Failing(where):
                return Awaiting(bench.start(make(bench), awaited=True))
        case Pause(seconds):
            return Awaiting(bench.set_wait(seconds))
        case Choice(guard, then, otherwise, where):
            with _Failing(where):
                holds = guard(bench.view())
            return begin_block(bench, then if holds else otherwise, "then" if holds else "else")
        case Together(branches):
            return _fork([_begin(bench, branch) for branch in branches])
    raise AssertionError(deed)


def _resume(bench: "Workbench", deed: Deed, position: Position, id: str) -> Position | None:
    match deed, position:
        case Choice(), Within(block, _, _):
            return resume(bench, deed.block(block), position, id)
        case Together(branches), Fork(positions):
            return _fork([_move(bench, branch, place, id) for branch, place in zip(branches, positions, strict=True)])
    return None


def _move(bench: "Workbench", deed: Deed, position: Position | None, id: str) -> Position | None:
    return _resume(bench, deed, position, id) if position is not None and id in awaited(position) else position


def _fork(branches: list[Position | None]) -> Fork | None:
    return Fork(tuple(branches)) if any(branch is not None for branch in branches) else None


class _Failing:
    """Turns what an expression or action raises into a DeedError with its place."""

    def __init__(self, where: NodePath) -> None:
        self.where = where

    def __enter__(self) -> None: ...

    def __exit__(self, kind: object, error: BaseException | None, trace: object) -> None:
        if isinstance(error, ExpressionError | ActionError):
            raise DeedError(str(error), self.where) from error


def _compile(action: Action, where: NodePath) -> Deed:
    match action:
        case Wait(seconds):
            return Pause(seconds)
        case Parallel(branches):
            return Together(compile_do(branches))
        case If(guard, then, otherwise):
            return Choice(compile_guard(guard.source), compile_do(then), compile_do(otherwise), guard.where)
        case Assign() | Raise() | Send() | CancelSend() | PublishBody() | LogText():
            return Instant(compile_action(action), where)
    return Awaited(compile_command(action), where)
