"""Plays a story: does what it says, waits for what it expects, and reports where it failed."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace
from math import inf
from typing import Any, NamedTuple, Protocol, assert_never

from lumen.errors import BusError
from lumen.interpreters.statechart import Step
from lumen.interpreters.statechart.nesting import active_names, entered_names
from lumen.interpreters.statechart.property_monitor import Violation, monitors
from lumen.interpreters.wall_clock import MICROSECONDS, next_moment
from lumen.language.approvals import Autonomy
from lumen.language.causes import OPERATOR, VISITOR, Cause, MessageOrigin
from lumen.language.commands import Ask, Cancel, Command, Play, Publish, Say, Start
from lumen.language.diagnostics import NodePath
from lumen.language.events import Event
from lumen.language.hours import Schedule
from lumen.language.machines import MachineDefinition
from lumen.language.projects import Project
from lumen.language.stories import (
    AnswerQuestion,
    Approve,
    Arrive,
    AwaitTime,
    Expect,
    Happen,
    Leave,
    Press,
    SendMessage,
    SetAutonomy,
    Speak,
    Story,
    StoryPause,
    TouchSensor,
    VisitorAction,
)
from lumen.ports import Bus, Hall
from lumen.runtime.loop import Observer
from lumen.runtime.questions import ANSWER_ROUTE
from lumen.runtime.sending import send
from lumen.runtime.story_time import story_moment
from lumen.runtime.visitor import VisitorActor

FALLEN = "fallen"
QUESTION_WITHIN = 30.0
"""How long `answers` waits for a question [s]."""


class UnmetExpectation(NamedTuple):
    """What was expected, and what was instead, in words."""

    expected: str
    was: str


class StoryFailure(NamedTuple):
    """Why a story failed: in which step (from 1) that stands `where`, what was expected, and what was."""

    story: str
    step: int
    where: NodePath
    expected: str
    was: str

    def __str__(self) -> str:
        return f"step {self.step} of `{self.story}`: {self.what}"

    @property
    def what(self) -> str:
        """What was expected, and what was."""
        return f"expected {self.expected}, but {self.was}" if self.expected else self.was


def staged(project: Project, story: Story | None) -> Project:
    """The project with the behaviour that the story is about as the one that runs."""
    return replace(project, behavior=story.behavior) if story and story.behavior else project


@dataclass
class StoryObservations:
    """What has been seen: the states now, where the robot is, and since the last expectation that held what was said,
    played and published; `asked` is the question that nobody has answered yet, by its id.
    """

    states: frozenset[str] = frozenset()
    context: dict[str, object] = field(default_factory=dict)
    place: str = ""
    said: list[str] = field(default_factory=list)
    played: list[str] = field(default_factory=list)
    published: list[tuple[str, Any]] = field(default_factory=list)
    playing: dict[str, str] = field(default_factory=dict)
    asked: str = ""

    def lacks(self, expected: Expect) -> UnmetExpectation | None:
        """The first thing of `expected` that does not hold."""
        if missing := [s for s in expected.states if s not in self.states]:
            return UnmetExpectation(f"state `{missing[0]}`", f"active are {_names(self.states)}")
        if expected.place is not None and expected.place != self.place:
            return UnmetExpectation(f"the robot at `{expected.place}`", f"it is {_at(self.place)}")
        return self._unheard(expected) or self._unsent(expected) or self._unlike(expected.context)

    def _unheard(self, expected: Expect) -> UnmetExpectation | None:
        part, whole = expected.said, expected.said_exactly
        if part is not None and not any(part.lower() in text.lower() for text in self.said):
            return UnmetExpectation(f"to hear “{part}”", f"it said {_texts(self.said)}")
        if whole is not None and whole not in self.said:
            return UnmetExpectation(f"to hear exactly “{whole}”", f"it said {_texts(self.said)}")
        if expected.played is not None and expected.played not in self.played:
            return UnmetExpectation(f"the motion `{expected.played}`", f"it played {_names(self.played)}")
        return None

    def _unsent(self, expected: Expect) -> UnmetExpectation | None:
        route, body = expected.published, expected.body
        if route is None or any(name == route and _holds(sent, body) for name, sent in self.published):
            return None
        wanted = f" with {body!r}" if body is not None else ""
        sent = "; ".join(f"{sent!r} on `{name}`" for name, sent in self.published)
        return UnmetExpectation(f"a message on `{route}`{wanted}", f"it sent {sent or 'nothing'}")

    def _unlike(self, context: Mapping[str, Any]) -> UnmetExpectation | None:
        for key, value in context.items():
            if self.context.get(key) != value:
                return UnmetExpectation(f"{key} = {value!r}", f"it is {self.context.get(key)!r}")
        return None

    def hear(self, event: Event | None) -> None:
        """The behaviour took this event: one that answers the question leaves none open, but for a filler."""
        if event and self.asked and event.name.endswith(f".command.{self.asked}"):
            self.asked = self.asked if event.data and event.data.get("filler") else ""

    def forget(self) -> None:
        self.said, self.played, self.published = [], [], []


class StoryEnvironment(Protocol):
    """Where a story plays: an exhibition, in this process or in others."""

    @property
    def bus(self) -> Bus: ...

    @property
    def project(self) -> Project: ...

    def happen(self, event: Event) -> None: ...

    def press(self, label: str, by: str) -> str:
        """Press a button; why that can't be, empty where it can."""
        ...

    def approve(self, by: str, *, go: bool) -> str:
        """Decide what waits longest for approval; why that can't be, empty where it can."""
        ...

    def set_autonomy(self, level: Autonomy, by: str) -> None:
        """Whether marked transitions wait for GO."""
        ...


class StoryPlayer(Observer):
    """One story on an exhibition, which it watches; call `tick` with its time.

    It is `finished` when its last step is done or one has failed; `failed` says what was expected where.
    """

    failed: StoryFailure | None = None

    def __init__(
        self,
        story: Story,
        exhibition: StoryEnvironment,
        hall: Hall,
        walker: VisitorActor,
        tell: Callable[[VisitorAction], None] = lambda _: None,
    ) -> None:
        self.story = story
        self.position = 0
        self._exhibition, self._hall, self._walker = exhibition, hall, walker
        self._tell = tell
        self._witness = StoryObservations()
        self._missed: UnmetExpectation | None = None
        self._begun = self._since = 0.0
        self._awaited: int | None = None
        machine = exhibition.project.behaviors[story.behavior or exhibition.project.behavior]
        self._monitors = monitors(machine, (*machine.properties, *story.properties))
        self._falls = expects_fall(story, machine)

    @property
    def failure(self) -> str:
        """Why it failed, in a line; empty where it has not."""
        return str(self.failed or "")

    @property
    def finished(self) -> bool:
        return self.failed is not None or self.position >= len(self.story.steps)

    def start(self, now: float) -> None:
        """Its first step begins at `now` [s], where that is not 0."""
        self._begun = self._since = now

    def stepped(self, step: Step) -> None:
        for monitor in self._monitors:
            self._violated(monitor.step(step.snapshot))
        self._witness.hear(step.event)
        self.see(active_names(step.snapshot), entered_names(step), step.snapshot.context, step.snapshot.place)

    def see(self, states: frozenset[str], entered: Iterable[str], context: Mapping[str, Any], place: str = "") -> None:
        """These states are active now, after those were entered; that is what the behaviour remembers, and the place
        where it knows the robot to be.
        """
        self._witness.states, self._witness.context, self._witness.place = states, dict(context), place
        if bad := states.union(entered).intersection(self.story.never):
            self.fail(UnmetExpectation(f"never state {_names(bad)}", "it was entered"))

    def performing(self, command: Command, now: float) -> None:
        match command:
            case Start(_, Say(text)):
                self._witness.said.append(text)
            case Start(id, Ask()):
                self._witness.asked = id
            case Start(id, Play(motion)):
                self._witness.playing[id] = motion
            case Cancel(id) if id == self._witness.asked:
                self._witness.asked = ""
            case Publish(route, body):
                self._witness.published.append((route, body))

    def answered(self, event: Event) -> None:
        if event.name == FALLEN and not self._falls:
            self.fail(UnmetExpectation("the robot on its feet", "it fell"))
        if event.name.startswith("done.command."):
            motion = self._witness.playing.pop(event.name.removeprefix("done.command."), None)
            if motion:
                self._witness.played.append(motion)

    def tick(self, now: float) -> None:
        """Do every step that can be done by `now` [s]; what is done is heard before anything is expected of it."""
        for monitor in sorted(self._monitors, key=lambda monitor: monitor.deadline):
            self._violated(monitor.elapse(now))
        heard = True
        while heard and not self.finished and self._do(now):
            heard = isinstance(self.story.steps[self.position].action, StoryPause | AwaitTime | Expect)
            self.position += 1
            self._since, self._awaited = now, None

    def quiet_until(self, now: float) -> float:
        """Until when it does nothing [s], unless something happens that it expects."""
        if self.finished:
            return now
        return min(self._quiet_until(now), *(monitor.deadline for monitor in self._monitors), inf)

    def _quiet_until(self, now: float) -> float:
        match self.story.steps[self.position].action:
            case StoryPause(seconds):
                return self._since + seconds
            case AnswerQuestion() if not self._witness.asked:
                return self._since + QUESTION_WITHIN
            case Expect() as expected if self._witness.lacks(expected):
                return self._since + expected.within
            case AwaitTime() if self._awaited is not None:
                return now + (self._awaited - self._moment(now)) / MICROSECONDS
        return now

    def _violated(self, violation: Violation | None) -> None:
        if violation:
            self.fail(UnmetExpectation(f"the property `{violation.property.name}`", violation.how))

    def _do(self, now: float) -> bool:
        action = self.story.steps[self.position].action
        if not isinstance(action, StoryPause | AwaitTime | Expect | AnswerQuestion):
            self._tell(action)
        match action:
            case StoryPause(seconds):
                return now >= self._since + seconds
            case AwaitTime(schedule):
                return self._shows(schedule, now)
            case Expect():
                return self._expect(action, now)
            case AnswerQuestion():
                return self._answer(action, now)
            case Arrive(visitor):
                self._walker.arrive(visitor)
            case Leave():
                self._walker.leave()
            case Speak(text, language):
                self._walker.speak(text, language)
            case TouchSensor(sensor, pressed):
                self._hall.touch(sensor, pressed)
            case Happen(name, data):
                self._exhibition.happen(Event(name, data, now, cause=Cause("person", sender=VISITOR)))
            case Press(label):
                if reason := self._exhibition.press(label, OPERATOR):
                    self.fail(UnmetExpectation("", reason))
            case Approve(go):
                if reason := self._exhibition.approve(OPERATOR, go=go):
                    self.fail(UnmetExpectation("", reason))
            case SetAutonomy(level):
                self._exhibition.set_autonomy(level, OPERATOR)
            case SendMessage(name, body):
                if reason := send(
                    self._exhibition.bus, self._exhibition.project, name, body, MessageOrigin(sender=VISITOR)
                ):
                    self.fail(UnmetExpectation(f"to send on `{name}`", reason))
            case _:
                assert_never(action)
        return True

    def _shows(self, schedule: Schedule, now: float) -> bool:
        """Whether the clock on the wall has come to a time of day since the step began."""
        if self._awaited is None:
            before = self._moment(self._since) - 1
            self._awaited = next_moment(schedule, before, self._exhibition.project.timezone)
        if self._awaited is None:
            self.fail(UnmetExpectation("", f"it is past `{schedule.text}`, and does not come again"))
            return False
        return self._moment(now) >= self._awaited

    def _answer(self, answer: AnswerQuestion, now: float) -> bool:
        """Answer the question that was asked last, once there is one."""
        id, self._witness.asked = self._witness.asked, ""
        if id:
            self._tell(answer)
            said = (
                {"raise": {"event": answer.event, "data": dict(answer.data)}} if answer.event else {"text": answer.text}
            )
            body = {"id": id, "source": "story", **said}
            try:
                self._exhibition.bus.publish(self._exhibition.project.key_of(ANSWER_ROUTE), body)
            except BusError as error:
                self.fail(UnmetExpectation("to answer a question", str(error)))
        elif now >= self._since + QUESTION_WITHIN:
            self.fail(
                UnmetExpectation(f"within {QUESTION_WITHIN:g} s a question to the module `answers`", "none was asked")
            )
        return bool(id)

    def _moment(self, now: float) -> int:
        return story_moment(self.story, self._exhibition.project.timezone, now - self._begun)

    def _expect(self, expected: Expect, now: float) -> bool:
        lacking = self._witness.lacks(expected)
        if not lacking:
            self._witness.forget()
            self._missed = None
            return True
        if self._witness.states.issuperset(expected.states):
            self._missed = lacking
        if now >= self._since + expected.within:
            lacking = self._missed or lacking
            self.fail(lacking._replace(expected=f"within {expected.within:g} s {lacking.expected}"))
        return False

    def fail(self, lack: UnmetExpectation) -> None:
        """End the story at the step it stands at; where it has failed already, that counts."""
        position = min(self.position, len(self.story.steps) - 1)
        self.failed = self.failed or StoryFailure(
            self.story.name, position + 1, self.story.steps[position].where, *lack
        )


def expects_fall(story: Story, machine: MachineDefinition) -> bool:
    """Whether a story says that the robot falls: by the event, or by expecting a state that answers it."""
    answers = {
        machine.states[target].name
        for state in machine.states.values()
        for transition in state.transitions
        if transition.event == FALLEN
        for target in transition.targets
    }
    actions = [step.action for step in story.steps]
    return any(isinstance(a, Happen) and a.name == FALLEN for a in actions) or any(
        isinstance(a, Expect) and not answers.isdisjoint(a.states) for a in actions
    )


def _holds(body: Any, wanted: Any) -> bool:
    """Whether a body has all that is wanted of it: of a map the keys given, of a list every item."""
    if isinstance(wanted, Mapping) and isinstance(body, Mapping):
        return all(key in body and _holds(body[key], value) for key, value in wanted.items())
    return wanted is None or bool(body == wanted)


def _names(names: object) -> str:
    listed = ", ".join(f"`{n}`" for n in sorted(names))  # type: ignore[call-overload]
    return listed or "nothing"


def _at(place: str) -> str:
    return f"at `{place}`" if place else "at none of the places"


def _texts(texts: list[str]) -> str:
    return "; ".join(f"“{t}”" for t in texts) or "nothing"
