"""Moves one `do` forward from action to action until it has to wait or ends."""

import re
from dataclasses import replace
from typing import Literal, Protocol

from lumen.expressions import ExpressionError
from lumen.language.commands import BodyCommand, Cancel, Say
from lumen.language.diagnostics import NodePath
from lumen.language.events import Event
from lumen.statechart.action_context import ActionContext, ActionError
from lumen.statechart.asking import MAX_SENTENCES, Sentence
from lumen.statechart.chart import StateNode
from lumen.statechart.do_actions import (
    AskedQuestion,
    AwaitedCommand,
    CompiledAction,
    ConditionalAction,
    InstantAction,
    ParallelActions,
    TimedWait,
)
from lumen.statechart.question_position import QuestionPosition, fork
from lumen.statechart.values import Awaiting, Fork, Position, Timer, Within, awaited

SPEECH_RATE = 17.0
"""The greatest speech rate of the robot [characters/s]."""
DOUBT = 1.0
"""Time [s] subtracted before the spoken part is estimated: repeating a sentence is better than losing one."""

_SENTENCE = re.compile(r"(?<=[.!?…])\s+")


def rest_of(command: BodyCommand, elapsed: float) -> BodyCommand:
    """Return the command to start again, `elapsed` [s] after its first start.

    A `say` restarts at the current sentence.
    """
    return replace(command, text=_remaining(command.text, elapsed)) if isinstance(command, Say) else command


def _remaining(text: str, elapsed: float) -> str:
    sentences = _SENTENCE.split(text)
    said = max(elapsed - DOUBT, 0.0) * SPEECH_RATE
    while len(sentences) > 1 and len(sentences[0]) < said:
        said -= len(sentences.pop(0)) + 1
    return " ".join(sentences)


class ActivityContext(ActionContext, Protocol):
    """The part of an `ExecutionContext` that activities use, in addition to what their actions use."""

    timers: tuple[Timer, ...]

    def offers(self, event: str) -> bool:
        """Return True if an active state has a transition for exactly that event that is marked as an `offer`."""

    def evaluate_in(self, node: StateNode) -> None:
        """Make this node the `state` that expressions read."""


class ActivityError(Exception):
    """The failure of an action of a `do`, with its reason and its place in the YAML."""

    def __init__(self, reason: str, where: NodePath) -> None:
        super().__init__(reason)
        self.reason, self.where = reason, where


def resumption_of(node: StateNode) -> str:
    """Return how the `do` of a state is resumed: `again`, `after` or `never`; empty if it starts anew."""
    return node.state.resume if node.state else ""


class Advance:
    """Moves one `do` forward until it has to wait; `started` collects the ids that it began."""

    __slots__ = ("context", "started")

    def __init__(self, context: ActivityContext) -> None:
        self.context = context
        self.started: list[str] = []

    def block(
        self, actions: tuple[CompiledAction, ...], name: Literal["do", "then", "else"] = "do", index: int = 0
    ) -> Within | None:
        """Execute the actions from `index` on up to the first that takes time; return its position, None at the end."""
        for place in range(index, len(actions)):
            inner = self.begin(actions[place])
            if inner is not None:
                return Within(name, place, inner)
        return None

    def resume_block(
        self, actions: tuple[CompiledAction, ...], position: Within, id: str, said: Sentence | None = None
    ) -> Within | None:
        """Continue from `position` after `id` has ended, or with the sentence `said` of the answer to question `id`.

        Return the new position; None at the end.
        """
        inner = self.resume(actions[position.place], position.inner, id, said)
        if inner is not None:
            return position._replace(inner=inner)
        return self.block(actions, position.block, position.place + 1)

    def again(self, node: StateNode, position: Within, at: float) -> Within | None:
        """Resume a `do` from a `position` that was left or lost at `at` [s], as the state's `resume` specifies.

        Return the new position; None if the `do` ends.
        """
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
                return fork([p and self._again(branch, p, at, after=after) for branch, p in pairs])
            case AwaitedCommand(make, where), Awaiting(_, since) if not after:
                with _Failing(where):
                    return self.awaiting(self.context.start(rest_of(make(self.context), at - since), awaited=True))
        return None if after else self.begin(action)

    def begin(self, action: CompiledAction) -> Position | None:
        """Begin one action; return the position in which it waits, None if it has ended."""
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
                return fork([self.begin(branch) for branch in branches])
            case AskedQuestion(make, _, within, _, where):
                with _Failing(where):
                    asked = self.awaiting(self.context.start(make(self.context), awaited=True))
                return Fork((asked, self.awaiting(self.context.wait(within)), None))
        raise AssertionError(action)

    def resume(
        self, action: CompiledAction, position: Position, id: str, said: Sentence | None = None
    ) -> Position | None:
        """Continue the action that waits under `id`, with the sentence `said` if it is a question's.

        Return the new position; None if the action has ended.
        """
        match action, position:
            case ConditionalAction(), Within(block, _, _):
                return self.resume_block(action.block(block), position, id, said)
            case ParallelActions(branches), Fork(positions):
                pairs = zip(branches, positions, strict=True)
                return fork([self.branch(branch, at, id, said) for branch, at in pairs])
            case AskedQuestion(), Fork((asked, deadline, filler, *sentences)):
                return self.question(action, QuestionPosition(asked, deadline, filler, tuple(sentences)), id, said)
            case AskedQuestion(), Within():
                return self.resume_block(action.otherwise, position, id, said)
        return None

    def branch(
        self, action: CompiledAction, position: Position | None, id: str, said: Sentence | None
    ) -> Position | None:
        """Continue one of several parallel branches if it awaits `id`; return its position, None if it has ended."""
        if position is None or id not in awaited(position):
            return position
        return self.resume(action, position, id, said)

    def question(
        self, action: AskedQuestion, stands: QuestionPosition, id: str, said: Sentence | None
    ) -> Position | None:
        """Handle a sentence of an answer, the end of an answer, its deadline, or the end of a spoken sentence.

        Return the new position; None if the question has ended.
        """
        if said and said.raises:
            if not self.context.offers(said.raises):
                return stands.fork()
            self.context.raise_event(Event(said.raises, said.data, self.context.at))
            return self.complete(stands)._replace(asked=None).fork()
        if said and said.filler:
            if stands.filler or stands.sentences:
                return stands.fork()
            return stands._replace(filler=self.speaking(action, said)).fork()
        if said:
            stands = stands._replace(sentences=(*stands.sentences, self.speaking(action, said)))
            if said.more and len(stands.sentences) < MAX_SENTENCES:
                return stands.fork()
            return self.complete(stands)._replace(asked=None).fork()
        if not {id}.isdisjoint(awaited(stands.answer)):
            cancel(self.context, [other for other in awaited(stands.answer) if other != id])
            if not stands.sentences:
                return self.block(action.otherwise, "else")
            return stands._replace(asked=None, deadline=None).fork()
        return stands.without(id).fork()

    def complete(self, stands: QuestionPosition) -> QuestionPosition:
        """Cancel the deadline of a question whose answer is complete; return the position without the deadline."""
        cancel(self.context, list(awaited(stands.deadline)))
        return stands._replace(deadline=None)

    def speaking(self, action: AskedQuestion, said: Sentence) -> Awaiting:
        """Start to say a sentence of an answer and return the position that awaits its end."""
        with _Failing(action.where):
            return self.awaiting(self.context.start(action.say(self.context, said), awaited=True))

    def awaiting(self, id: str) -> Awaiting:
        """Record that `id` was started, and return the position that awaits it."""
        self.started.append(id)
        return Awaiting(id, self.context.at)


class _Failing:
    """Converts an error of an expression or action into an ActivityError with its place."""

    __slots__ = ("where",)

    def __init__(self, where: NodePath) -> None:
        self.where = where

    def __enter__(self) -> None: ...

    def __exit__(self, kind: object, error: BaseException | None, trace: object) -> None:
        if isinstance(error, ExpressionError | ActionError):
            raise ActivityError(str(error), self.where) from error


def cancel(context: ActivityContext, ids: list[str]) -> None:
    """Cancel these ids: remove the timers of `wait`s, and send the robot a Cancel for every other id."""
    context.timers, cancels = cancelled(context.timers, ids)
    for command in cancels:
        context.emit(command)


def cancelled(timers: tuple[Timer, ...], ids: list[str]) -> tuple[tuple[Timer, ...], tuple[Cancel, ...]]:
    """Return the timers without the `wait`s among these ids, and a Cancel command for each other id."""
    waits = {t.id for t in timers if t.kind == "wait" and t.id in ids}
    kept = tuple(t for t in timers if t.kind != "wait" or t.id not in waits) if waits else timers
    return kept, tuple(Cancel(id) for id in ids if id not in waits)
