"""One `do` being moved on: from action to action, until it awaits something or is done."""

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
"""How many characters are said in a second, at most."""
DOUBT = 1.0
"""How much earlier it may have been [s]: a sentence said twice is better than one not heard."""

_SENTENCE = re.compile(r"(?<=[.!?…])\s+")


def rest_of(command: BodyCommand, elapsed: float) -> BodyCommand:
    """A command that begins again, `elapsed` [s] after it first began: of what is said, that sentence and the rest."""
    return replace(command, text=_remaining(command.text, elapsed)) if isinstance(command, Say) else command


def _remaining(text: str, elapsed: float) -> str:
    sentences = _SENTENCE.split(text)
    said = max(elapsed - DOUBT, 0.0) * SPEECH_RATE
    while len(sentences) > 1 and len(sentences[0]) < said:
        said -= len(sentences.pop(0)) + 1
    return " ".join(sentences)


class ActivityContext(ActionContext, Protocol):
    """The part of an `ExecutionContext` that activities use, besides what their actions do."""

    timers: tuple[Timer, ...]

    def offers(self, event: str) -> bool:
        """Whether an active state has a transition for just that event which is marked as an `offer`."""

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


class Advance:
    """One `do` being moved on until it awaits something; `started` are the ids of what it began."""

    __slots__ = ("context", "started")

    def __init__(self, context: ActivityContext) -> None:
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

    def resume_block(
        self, actions: tuple[CompiledAction, ...], position: Within, id: str, said: Sentence | None = None
    ) -> Within | None:
        """Go on from `position` now that what it awaited under `id` is over, or has brought a sentence to be said."""
        inner = self.resume(actions[position.place], position.inner, id, said)
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
                return fork([p and self._again(branch, p, at, after=after) for branch, p in pairs])
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
                return fork([self.begin(branch) for branch in branches])
            case AskedQuestion(make, _, within, _, where):
                with _Failing(where):
                    asked = self.awaiting(self.context.start(make(self.context), awaited=True))
                return Fork((asked, self.awaiting(self.context.wait(within)), None))
        raise AssertionError(action)

    def resume(
        self, action: CompiledAction, position: Position, id: str, said: Sentence | None = None
    ) -> Position | None:
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
        if position is None or id not in awaited(position):
            return position
        return self.resume(action, position, id, said)

    def question(
        self, action: AskedQuestion, stands: QuestionPosition, id: str, said: Sentence | None
    ) -> Position | None:
        """A sentence of the answer came; or the answer is complete, its time is up, or a sentence has been said."""
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
        """Nothing more is awaited but that all is said."""
        cancel(self.context, list(awaited(stands.deadline)))
        return stands._replace(deadline=None)

    def speaking(self, action: AskedQuestion, said: Sentence) -> Awaiting:
        with _Failing(action.where):
            return self.awaiting(self.context.start(action.say(self.context, said), awaited=True))

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


def cancel(context: ActivityContext, ids: list[str]) -> None:
    """Cancel what is awaited under these ids: a timer is taken back, a command cancelled at the robot."""
    context.timers, cancels = cancelled(context.timers, ids)
    for command in cancels:
        context.emit(command)


def cancelled(timers: tuple[Timer, ...], ids: list[str]) -> tuple[tuple[Timer, ...], tuple[Cancel, ...]]:
    """The timers without those that are awaited under these ids, and the commands that cancel the others."""
    waits = {t.id for t in timers if t.kind == "wait" and t.id in ids}
    kept = tuple(t for t in timers if t.kind != "wait" or t.id not in waits) if waits else timers
    return kept, tuple(Cancel(id) for id in ids if id not in waits)
