"""The `do` of active states while it runs: begun after entry, resumed by answers, ended on exit (UML's do activity)."""

from collections.abc import Callable, Iterable, Mapping
from typing import Literal, Protocol

from lumen.interpreters.expressions import ExpressionError
from lumen.interpreters.statechart.action_context import ActionContext, ActionError
from lumen.interpreters.statechart.chart import StateNode
from lumen.interpreters.statechart.do_actions import (
    AwaitedCommand,
    CompiledAction,
    ConditionalAction,
    InstantAction,
    ParallelActions,
    TimedWait,
)
from lumen.interpreters.statechart.spoken import rest_of
from lumen.interpreters.statechart.values import Awaiting, Fork, Halted, Position, Timer, Within, awaited
from lumen.language.commands import Cancel
from lumen.language.diagnostics import NodePath
from lumen.language.events import Event


class ActivityContext(ActionContext, Protocol):
    """The part of an `ExecutionContext` that activities use, besides what their actions do."""

    timers: tuple[Timer, ...]

    def evaluate_in(self, node: StateNode) -> None:
        """Let `state` in expressions be this one."""


class ActivityError(Exception):
    """An action of a `do` failed; carries the reason and the place."""

    def __init__(self, reason: str, where: NodePath) -> None:
        super().__init__(reason)
        self.reason, self.where = reason, where


def resumption_of(node: StateNode) -> str:
    """How the `do` of a state is resumed: `again`, `after`, `never`; empty where it begins anew."""
    return node.state.resume if node.state else ""


class Activities:
    """How far each `do` has come, by the path of its state; `halted` are those that were left before their end."""

    __slots__ = ("halted", "positions")

    def __init__(self, positions: Mapping[str, Within], halted: Mapping[str, Halted]) -> None:
        self.positions, self.halted = positions, halted

    def begin(self, context: ActivityContext, node: StateNode, halted: Halted | None = None) -> None:
        """Begin what a state does while it is active; where it was halted, as the state says of its `resume`."""
        if halted is None:
            self._advance(context, node, lambda advance: advance.block(node.do))
        else:
            self._advance(context, node, lambda advance: advance.again(node, halted.position, halted.at))

    def resume(self, context: ActivityContext, node: StateNode, id: str) -> None:
        """Go on with the `do` of that state, since what it awaited under that id is over."""
        position = self.positions[node.path]
        self._advance(context, node, lambda advance: advance.resume_block(node.do, position, id), id)

    def lose(self, context: ActivityContext, node: StateNode, id: str, reason: str) -> None:
        """Go on with the `do` of that state though the robot has forgotten what it awaits, as its `resume` says."""
        if not resumption_of(node):
            self.fail(context, node, id, reason)
            return
        position = self.positions[node.path]
        _cancel(context, [other for other in awaited(position) if other != id])
        self._advance(context, node, lambda advance: advance.again(node, position, context.at))

    def fail(
        self, context: ActivityContext, node: StateNode, id: str | None, reason: str, started: Iterable[str] = ()
    ) -> None:
        """End a `do` that failed: what else it awaits is cancelled, and its state hears why.

        `id` is that of the command that failed, None for an action that takes no time; `started` is what was begun
        since the position that is known.
        """
        pending = (*awaited(self.positions.get(node.path)), *started)
        _cancel(context, [other for other in pending if other != id])
        self._place(node.path, None)
        context.raise_event(Event(f"error.do.{node.name}", {"command": id, "reason": reason}, context.at))

    def cancel(self, context: ActivityContext, path: str) -> None:
        """End a `do` whose state is left."""
        _cancel(context, list(awaited(self.positions[path])))
        self._place(path, None)

    def halt(self, node: StateNode, at: float) -> None:
        """Note where the `do` of a state that is left stands, where the state says how it is resumed."""
        if resumption_of(node):
            self.halted = {**self.halted, node.path: Halted(self.positions[node.path], at)}

    def forget(self, path: str) -> Halted | None:
        """Where the `do` of a state that is entered again had stood; it is forgotten."""
        found = self.halted.get(path)
        if found:
            self.halted = {other: halted for other, halted in self.halted.items() if other != path}
        return found

    def _advance(
        self,
        context: ActivityContext,
        node: StateNode,
        move: Callable[["_Advance"], Within | None],
        id: str | None = None,
    ) -> None:
        context.evaluate_in(node)
        advance = _Advance(context)
        try:
            position = move(advance)
        except ActivityError as error:
            context.raise_error(error.reason, error.where)
            self.fail(context, node, id, error.reason, advance.started)
            return
        self._place(node.path, position)
        if position is None:
            context.raise_event(Event(f"done.do.{node.name}", None, context.at))

    def _place(self, path: str, position: Within | None) -> None:
        rest = {p: where for p, where in self.positions.items() if p != path}
        self.positions = {**rest, path: position} if position else rest


class _Advance:
    """One `do` being moved on until it awaits something; `started` are the ids of what it began."""

    __slots__ = ("context", "started")

    def __init__(self, context: ActionContext) -> None:
        self.context = context
        self.started: list[str] = []

    def block(
        self, actions: tuple[CompiledAction, ...], name: Literal["do", "then", "else"] = "do", index: int = 0
    ) -> Within | None:
        """Do everything from `index` on that takes no time; where it stands then, None at its end."""
        for place in range(index, len(actions)):
            inner = self.begin(actions[place])
            if inner is not None:
                return Within(name, place, inner)
        return None

    def resume_block(self, actions: tuple[CompiledAction, ...], position: Within, id: str) -> Within | None:
        """Go on from `position` now that what it awaited under `id` is over."""
        inner = self.resume(actions[position.place], position.inner, id)
        if inner is not None:
            return position._replace(inner=inner)
        return self.block(actions, position.block, position.place + 1)

    def again(self, node: StateNode, position: Within, at: float) -> Within | None:
        """Go on from a `position` that was left, or lost, at `at` [s], as the state says of its `resume`."""
        word = resumption_of(node)
        return None if word == "never" else self._again_block(node.do, position, at, after=word == "after")

    def _again_block(
        self, actions: tuple[CompiledAction, ...], position: Within, at: float, *, after: bool
    ) -> Within | None:
        inner = self._again(actions[position.place], position.inner, at, after=after)
        if inner is not None:
            return position._replace(inner=inner)
        return self.block(actions, position.block, position.place + 1)

    def _again(self, action: CompiledAction, position: Position, at: float, *, after: bool) -> Position | None:
        match action, position:
            case ConditionalAction(), Within(block, _, _):
                return self._again_block(action.block(block), position, at, after=after)
            case ParallelActions(branches), Fork(positions):
                pairs = zip(branches, positions, strict=True)
                return _fork([p and self._again(branch, p, at, after=after) for branch, p in pairs])
            case AwaitedCommand(make, where), Awaiting(_, since) if not after:
                with _Failing(where):
                    return self.awaiting(self.context.start(rest_of(make(self.context), at - since), awaited=True))
        return None if after else self.begin(action)

    def begin(self, action: CompiledAction) -> Position | None:
        match action:
            case InstantAction(act, where):
                with _Failing(where):
                    act(self.context)
                return None
            case AwaitedCommand(make, where):
                with _Failing(where):
                    return self.awaiting(self.context.start(make(self.context), awaited=True))
            case TimedWait(seconds):
                return self.awaiting(self.context.wait(seconds))
            case ConditionalAction(guard, then, otherwise, where):
                with _Failing(where):
                    holds = guard(self.context.scope())
                return self.block(then if holds else otherwise, "then" if holds else "else")
            case ParallelActions(branches):
                return _fork([self.begin(branch) for branch in branches])
        raise AssertionError(action)

    def resume(self, action: CompiledAction, position: Position, id: str) -> Position | None:
        match action, position:
            case ConditionalAction(), Within(block, _, _):
                return self.resume_block(action.block(block), position, id)
            case ParallelActions(branches), Fork(positions):
                return _fork([self.branch(branch, at, id) for branch, at in zip(branches, positions, strict=True)])
        return None

    def branch(self, action: CompiledAction, position: Position | None, id: str) -> Position | None:
        return self.resume(action, position, id) if position is not None and id in awaited(position) else position

    def awaiting(self, id: str) -> Awaiting:
        self.started.append(id)
        return Awaiting(id, self.context.at)


class _Failing:
    """Turns what an expression or action raises into an ActivityError with its place."""

    __slots__ = ("where",)

    def __init__(self, where: NodePath) -> None:
        self.where = where

    def __enter__(self) -> None: ...

    def __exit__(self, kind: object, error: BaseException | None, trace: object) -> None:
        if isinstance(error, ExpressionError | ActionError):
            raise ActivityError(str(error), self.where) from error


def _fork(branches: list[Position | None]) -> Fork | None:
    return Fork(tuple(branches)) if any(branch is not None for branch in branches) else None


def _cancel(context: ActivityContext, ids: list[str]) -> None:
    """Cancel what is awaited under these ids: a timer is taken back, a command cancelled at the robot."""
    waits = {t.id for t in context.timers if t.kind == "wait" and t.id in ids}
    context.timers = tuple(t for t in context.timers if t.kind != "wait" or t.id not in waits)
    for id in ids:
        if id not in waits:
            context.emit(Cancel(id))
