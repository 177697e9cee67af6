"""Operators' requests to a running exhibition: its status, its past, decisions, and direct entry of a state."""

from collections import deque
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

from lumen.errors import BusError, LumenError
from lumen.journal.journal_writer import JournalWriter
from lumen.language.causes import Cause
from lumen.language.events import Event
from lumen.language.modules import EARS
from lumen.language.operator_requests import (
    APPROVE,
    AUTONOMY,
    EVENT,
    FORK,
    GOTO,
    JOURNAL,
    MARK,
    MODEL,
    NOTE,
    NOW,
    PRESS,
    STATUS,
    WHY,
    WHY_NOT,
)
from lumen.ports import Message, Sense
from lumen.robot.person_hold import StoppedBy
from lumen.robot.robot_routes import TEXT_ROUTE
from lumen.run.activity_tracker import ActivityTracker
from lumen.run.answering import AnsweringThread
from lumen.run.asking import operator_key
from lumen.run.decisions import DecisionRecords, Decisions, ModelSwitch, RequestChecks
from lumen.run.live_behavior import LiveBehavior
from lumen.run.loop import Observer
from lumen.run.narrator import Narrator
from lumen.run.now import NowView, PresentMoment, moment
from lumen.run.parts.part import Part
from lumen.run.raised_events import RaisedEvents, person_in, refusal
from lumen.run.status import LastReload, status_of
from lumen.run.step_memory import StepMemory
from lumen.statechart import Step
from lumen.statechart.direct_entry import entered_directly

DIRECT_ENTRY = "operator.goto"
"""The event of a step that an operator requested by `goto`."""
EARS_LOST = f"{EARS}.lost"
MAX_PENDING_REQUESTS = 100
"""The number of requests that may wait for a tick; one more drops the oldest."""
NOTHING_RECORDED = "the bus is not recorded: `record: {ring: 10min}` in lumen.yaml keeps the last 10 minutes"
MAX_NOTE = 300
"""The greatest length of the text of a mark or a note [characters]."""
MAX_STATE = 200
"""The greatest length of a state's name [characters]."""
Responder = Callable[[Message, float], dict[str, Any]]
"""A function that returns the answer to a valid request at a time [s]."""
Handler = Callable[[Message, float], None]
"""A function that sees to it that a valid request at a time [s] is answered, now or later."""


@dataclass(frozen=True, slots=True)
class RunState:
    """The state of the run, as functions that return it."""

    stopped: Callable[[], StoppedBy | None]
    """Returns who stopped the robot; None if it is not stopped."""
    realtime: Callable[[], float]
    """Returns the share of real time that the clock reaches."""
    reloaded: Callable[[], LastReload | None] = lambda: None
    """Returns the last reload; None if there was none."""
    modules: Callable[[], Sequence[Mapping[str, Any]]] = tuple
    """Returns the status of each of the project's own modules."""
    skills: Callable[[], Mapping[str, Any]] = dict
    """Returns the state of each of the project's skills that this process performs."""


class OperatorPart(Part, Observer):
    """The part that answers operators between two steps; it comes before the brain, and has the brain's `needs`.

    Questions about the past (`lumen why`) are answered on another thread, from its `steps` and from the journal that
    `journal` writes. `records` writes journal entries and saves people's decisions. The folder `kept` has what outlasts
    the run: whether the language model is silenced. `marking` returns the answer to a mark, which the recorder receives
    by itself; it is empty if nothing is recorded.
    """

    patient = True
    watches = True

    def __init__(
        self,
        behavior: LiveBehavior,
        narrator: Narrator,
        journal: JournalWriter,
        records: DecisionRecords,
        run: RunState,
        *,
        marking: Callable[[], str] = str,
        kept: Path | None = None,
        needs: Sequence[str] = (),
    ) -> None:
        self.needs, self._behavior, self._narrator, self._record = needs, behavior, narrator, records.write
        self._run, self._marking = run, marking
        self._since = 0.0
        self._received: deque[Message] = deque(maxlen=MAX_PENDING_REQUESTS)
        self._bus = behavior.loop.bus
        runtime = behavior.loop.runtime
        self.steps = StepMemory(lambda: runtime.project, lambda: runtime.snapshot if runtime.begun else None)
        self._journal = journal
        self._answering = AnsweringThread(self._bus, self.steps.steps, journal)
        self._pages = AnsweringThread(self._bus, list, journal)  # so that consoles do not wait for a `why`
        self._undo = self._bus.subscribe(operator_key(behavior.project.robot), self._received.append)
        self._view = NowView()
        self._activity = ActivityTracker(
            lambda: runtime.project, lambda: runtime.snapshot if runtime.begun else None, behavior.loop.clock.now
        )
        self._ears: Mapping[str, Any] | None = None
        self._stop_listening = self._bus.subscribe(behavior.project.key_of("listening"), self._on_listening)
        self._unsay = self._bus.subscribe(behavior.project.key_of(TEXT_ROUTE), self._activity.told.append)
        told = [behavior.trace.approval] if behavior.trace in behavior.loop.observers else []
        self._decisions = Decisions(runtime.approvals, narrator, records.write, records.keep_decisions, *told)
        runtime.approvals.watchers.append(self._activity)
        behavior.forgetters += [self.steps, self._activity, runtime.approvals]
        self.model = ModelSwitch(behavior.loop.performer.questions, lambda: runtime.project, records.write, kept)
        self._raising = RaisedEvents(behavior.loop, self._reply)
        self._requests = RequestChecks()
        self._handlers = self._by_request()
        behavior.loop.observers += [self.steps, self._activity, self._raising]

    def _by_request(self) -> Mapping[str, Handler]:
        """Return the handler of each request, by its `ask`."""
        answers: Mapping[str, Responder] = {
            STATUS.ask: lambda _message, _now: self.status(),
            MARK.ask: self._mark,
            NOTE.ask: self._noted,
            APPROVE.ask: lambda m, _: self._decisions.approve(m.body["id"], person_in(m), go=m.body["go"]),
            AUTONOMY.ask: lambda m, _: self._decisions.autonomy(m.body["level"], person_in(m)),
            MODEL.ask: lambda m, _: self.model.switch(person_in(m), on=m.body["on"]),
            GOTO.ask: self._goto,
        }
        return {
            **{ask: partial(self._answer, respond) for ask, respond in answers.items()},
            EVENT.ask: self._raising.happen,
            PRESS.ask: self._raising.happen,
            WHY.ask: lambda message, _: self._answering.request(message),
            WHY_NOT.ask: lambda message, _: self._answering.request(message),
            FORK.ask: self._fork,
            JOURNAL.ask: lambda message, _: self._pages.request(message),
            NOW.ask: lambda message, _: self._pages.answer(message, partial(self._view.tell, self._moment())),
        }

    def begin(self, now: float) -> None:
        self._since = now

    def stepped(self, step: Step) -> None:
        if step.entered or step.exited or any(inner.entered or inner.exited for _, inner in step.invoked):
            self._since = step.snapshot.at

    def _on_listening(self, message: Message) -> None:
        """Store whether the ears listen and why; they publish each change."""
        match message.body:
            case {"listening": bool(listening), "because": str(because)}:
                self._ears = {"listening": listening, "because": because}

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        if any(change.name == EARS_LOST for change in changes):
            self._ears = None
        self.steps.look()
        self._activity.look()
        self._raising.look()
        while self._received:
            message = self._received.popleft()
            if request := self._requests.valid(message.body):
                self._handlers[request.ask](message, now)
            else:
                self._reply(message, refusal(self._requests.fault(message.body)))

    def close(self) -> None:
        self._undo()
        self._unsay()
        self._stop_listening()
        self._answering.close()
        self._pages.close()

    def recover(self, kept: Any, *, resumed: bool) -> None:
        """Restore people's decisions of the previous run, if this run resumes it."""
        self._decisions.recover(kept, resumed=resumed)

    def status(self) -> dict[str, Any]:
        """Return the state of the exhibition as JSON data."""
        return self._status()()

    def now(self) -> dict[str, Any]:
        """Return the state of the exhibition and the possible next events as JSON data."""
        return self._view.tell(self._moment())

    def _status(self) -> Callable[[], dict[str, Any]]:
        """Return a function that computes the status of this moment, later and on any thread."""
        loop = self._behavior.loop
        return partial(
            status_of,
            loop.project,
            loop.runtime.snapshot,
            self._since,
            battery=loop.robot.read(Sense.BATTERY),
            stopped=self._run.stopped(),
            realtime=self._run.realtime(),
            reloaded=self._run.reloaded(),
            said={"ears": self._ears, "modules": self._run.modules(), "skills": self._run.skills()},
        )

    def _moment(self) -> PresentMoment:
        loop, runtime = self._behavior.loop, self._behavior.loop.runtime
        return moment(
            runtime.project,
            runtime.snapshot,
            loop.clock.now(),
            self._activity,
            position=self._journal.tail.next - 1,
            approvals=runtime.approvals,
            model=self.model.state,
            events=loop.waiting,
            status=self._status(),
        )

    def _reply(self, message: Message, answer: Mapping[str, Any]) -> None:
        with suppress(BusError):  # the bus is closed, so no reply can be sent
            self._bus.reply(message, answer)

    def _answer(self, respond: Responder, message: Message, now: float) -> None:
        self._reply(message, respond(message, now))

    def _fork(self, message: Message, _: float) -> None:
        from lumen.run.forking import forked  # this imports the whole check of files

        running = self._behavior.loop.runtime.project
        self._answering.answer(message, partial(forked, self._journal, running, message.body))

    def _mark(self, message: Message, _: float) -> dict[str, Any]:
        kept = self._marking()
        self._note(message, "mark")
        return {"verdict": "done", "text": kept or f"in the journal; {NOTHING_RECORDED}"}

    def _noted(self, message: Message, _: float) -> dict[str, Any]:
        self._note(message, "note")
        return {"verdict": "done"}

    def _note(self, message: Message, what: str) -> None:
        """Write a text of a person or a program to the journal."""
        text = message.body.get("text")
        words = text[:MAX_NOTE] if isinstance(text, str) else ""
        self._behavior.loop.runtime.note(**{what: words, "by": person_in(message)})

    def _goto(self, message: Message, now: float) -> dict[str, Any]:
        """Enter a state; with `only: check`, just return the states that would be left and entered.

        The answer is a refusal if the state can't be entered.
        """
        state, by, only = message.body["state"][:MAX_STATE], person_in(message), message.body.get("only") == "check"
        loop = self._behavior.loop
        event = Event(DIRECT_ENTRY, {"by": by, "state": state}, now, cause=Cause("person", sender=by))
        try:
            step = entered_directly(loop.project.machine, loop.runtime.snapshot, state, event)
        except LumenError as error:
            return refusal(str(error))
        stopped = self._run.stopped()
        said = {"exited": list(step.exited), "entered": list(step.entered), "stopped_by": stopped and stopped.by}
        if only:
            return {"verdict": "possible", **said}
        self._narrator.line("operator", f"goes to {state}, by {by}")
        self._record({"goto": state, "by": by})
        loop.take(step)
        return {"verdict": "done", **said}
