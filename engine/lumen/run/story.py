"""The player of a story: it performs its actions, waits for its expectations, and reports the step that failed."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from math import inf
from typing import Any, NamedTuple, Protocol, assert_never

from lumen.errors import BusError
from lumen.expressions.wall_clock import MICROSECONDS, next_moment
from lumen.language.approvals import Autonomy
from lumen.language.causes import OPERATOR, VISITOR, Cause, MessageOrigin
from lumen.language.commands import Ask, Cancel, Command, Do, Play, Publish, Say, Start
from lumen.language.diagnostics import NodePath
from lumen.language.events import FALLEN, Event
from lumen.language.hours import Schedule
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
    SetSkills,
    Speak,
    Story,
    StoryPause,
    TouchSensor,
    VisitorAction,
)
from lumen.ports import Bus
from lumen.run.loop import Observer
from lumen.run.questions import ANSWER_ROUTE
from lumen.run.sending import send
from lumen.run.story_observations import StoryObservations, UnmetExpectation, expects_error, expects_fall, listed
from lumen.run.story_time import story_moment
from lumen.run.troubles import RunTrouble
from lumen.run.visitor import VisitorActor
from lumen.statechart import Step
from lumen.statechart.nesting import active_names, entered_names
from lumen.statechart.property_monitor import Violation, monitors

QUESTION_WITHIN = 30.0
"""The longest wait of `answers` for a question [s]."""


def answered(bus: Bus, project: Project, id: str, answer: AnswerQuestion, waited: float) -> UnmetExpectation | None:
    """Answer the question of an id; return the unmet expectation, None if all is well.

    An empty `id` means that no question was asked yet, which is a failure only after QUESTION_WITHIN. `waited` is the
    time since the step began [s].
    """
    if not id:
        wanted = f"a question to the module `answers` within {QUESTION_WITHIN:g} s"
        return UnmetExpectation(wanted, "none was asked") if waited >= QUESTION_WITHIN else None
    said = {"raise": {"event": answer.event, "data": dict(answer.data)}} if answer.event else {"text": answer.text}
    try:
        bus.publish(project.key_of(ANSWER_ROUTE), {"id": id, "source": "story", **said})
    except BusError as error:
        return UnmetExpectation("the answer to be sent", str(error))
    return None


class StoryFailure(NamedTuple):
    """Why a story failed."""

    story: str
    step: int
    """The number of the step, from 1."""
    where: NodePath
    """The place of the step in the file."""
    expected: str
    """The expectation, in words."""
    was: str
    """The actual outcome, in words."""

    def __str__(self) -> str:
        return f"step {self.step} of `{self.story}`: {self.what}"

    @property
    def what(self) -> str:
        """The expectation and the actual outcome, in one sentence."""
        return f"expected {self.expected}, but {self.was}" if self.expected else self.was


def staged(project: Project, story: Story | None) -> Project:
    """Return the project with the story's behaviour as the one that runs."""
    return replace(project, behavior=story.behavior) if story and story.behavior else project


class StoryEnvironment(Protocol):
    """The exhibition in which a story plays, in this process or in others."""

    @property
    def bus(self) -> Bus:
        """The exhibition's bus."""
        ...

    @property
    def project(self) -> Project:
        """The bundle that runs."""
        ...

    def happen(self, event: Event) -> None:
        """Raise an event in the behaviour."""
        ...

    def press(self, label: str, by: str) -> str:
        """Press a button; return why that is impossible, else an empty string."""
        ...

    def approve(self, by: str, *, go: bool) -> str:
        """Release or drop the event that has waited longest; return why that is impossible, else an empty string."""
        ...

    def set_autonomy(self, level: Autonomy, by: str) -> None:
        """Set whether marked transitions wait for GO."""
        ...


class StoryPlayer(Observer):
    """An observer that plays one story on an exhibition; call `tick` with the exhibition's time."""

    failed: StoryFailure | None = None
    """The failure; None if the story has not failed."""

    def __init__(
        self,
        story: Story,
        exhibition: StoryEnvironment,
        walker: VisitorActor,
        tell: Callable[[VisitorAction], None] = lambda _: None,
    ) -> None:
        self.story = story
        self.position = 0
        self._exhibition, self._walker = exhibition, walker
        self._tell = tell
        self._witness = StoryObservations()
        self._missed: tuple[UnmetExpectation, ...] = ()
        self._begun = self._since = 0.0
        self._awaited: int | None = None
        machine = exhibition.project.behaviors[story.behavior or exhibition.project.behavior]
        self._monitors = monitors(machine, (*machine.properties, *story.properties))
        self._falls, self._errors = expects_fall(story, machine), expects_error(story, machine)

    @property
    def failure(self) -> str:
        """Why the story failed, in one line; empty if it has not."""
        return str(self.failed or "")

    @property
    def finished(self) -> bool:
        """Whether the story's last step is done, or a step has failed."""
        return self.failed is not None or self.position >= len(self.story.steps)

    def start(self, now: float) -> None:
        """Begin the first step at `now` [s]; without this call, the first step begins at 0."""
        self._begun = self._since = now

    def stepped(self, step: Step) -> None:
        for monitor in self._monitors:
            self._violated(monitor.step(step.snapshot))
        self._witness.hear(step.event)
        self.see(active_names(step.snapshot), entered_names(step), step.snapshot.context, step.snapshot.place)

    def see(self, states: frozenset[str], entered: Iterable[str], context: Mapping[str, Any], place: str = "") -> None:
        """Store the active states, the context and the place; fail if a forbidden state is active or was entered."""
        self._witness.states, self._witness.context, self._witness.place = states, dict(context), place
        if bad := states.union(entered).intersection(self.story.never):
            self.fail(UnmetExpectation(f"never state {listed(bad)}", "it was entered"))

    def performing(self, command: Command, now: float) -> None:
        match command:
            case Start(_, Say(text)):
                self._witness.said.append(text)
            case Start(id, Ask()):
                self._witness.asked = id
            case Start(id, Play(motion)):
                self._witness.playing[id] = motion
            case Start(id, Do() as done):
                self._witness.doing[id] = done
            case Cancel(id) if id == self._witness.asked:
                self._witness.asked = ""
            case Publish(route, body):
                self._witness.published.append((route, body))

    def answered(self, event: Event) -> None:
        if event.name == FALLEN and not self._falls:
            self.fail(UnmetExpectation("the robot to stay on its feet", "it fell"))
        if event.name.startswith("done.command."):
            id = event.name.removeprefix("done.command.")
            if motion := self._witness.playing.pop(id, None):
                self._witness.played.append(motion)
            if done := self._witness.doing.pop(id, None):
                self._witness.did.append(done)

    def troubled(self, trouble: RunTrouble) -> None:
        expected = self._falls if trouble.kind == "fall" else self._errors if trouble.kind == "do" else False
        if trouble.kind != "fall" and not expected:  # a fall already failed in `answered`
            self.fail(UnmetExpectation("", trouble.what))

    def tick(self, now: float) -> None:
        """Do every step that is possible at `now` [s].

        After an action, the next step waits for the next tick, so that the behaviour receives the action before an
        expectation is tested.
        """
        for monitor in sorted(self._monitors, key=lambda monitor: monitor.deadline):
            self._violated(monitor.elapse(now))
        heard = True
        while heard and not self.finished and self._do(now):
            heard = isinstance(self.story.steps[self.position].action, StoryPause | AwaitTime | Expect)
            self.position += 1
            self._since, self._awaited = now, None

    def quiet_until(self, now: float) -> float:
        """Return the time until which the player does nothing [s], unless an expectation is met earlier."""
        if self.finished:
            return now
        return min(self._quiet_until(now), *(monitor.deadline for monitor in self._monitors), inf)

    def _quiet_until(self, now: float) -> float:
        match self.story.steps[self.position].action:
            case StoryPause(seconds):
                return self._since + seconds
            case AnswerQuestion() if not self._witness.asked:
                return self._since + QUESTION_WITHIN
            case Expect() as expected if self._witness.unmet(expected):
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
                self._walker.touch(sensor, pressed)
            case SetSkills(ends):
                self._walker.set_skills(ends)
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
                    self.fail(UnmetExpectation(f"a message to be sent on `{name}`", reason))
            case _:
                assert_never(action)
        return True

    def _shows(self, schedule: Schedule, now: float) -> bool:
        """Return whether the story's clock has reached a time of day since the step began; fail if it never will."""
        if self._awaited is None:
            before = self._moment(self._since) - 1
            self._awaited = next_moment(schedule, before, self._exhibition.project.timezone)
        if self._awaited is None:
            self.fail(UnmetExpectation("", f"`{schedule.text}` is in the past and will not come again"))
            return False
        return self._moment(now) >= self._awaited

    def _answer(self, answer: AnswerQuestion, now: float) -> bool:
        """Answer the last question; return False while no question was asked.

        The story fails if no question is asked within QUESTION_WITHIN, or the answer can't be sent.
        """
        id, self._witness.asked = self._witness.asked, ""
        if id:
            self._tell(answer)
        if lack := answered(self._exhibition.bus, self._exhibition.project, id, answer, now - self._since):
            self.fail(lack)
        return bool(id)

    def _moment(self, now: float) -> int:
        return story_moment(self.story, self._exhibition.project.timezone, now - self._begun)

    def _expect(self, expected: Expect, now: float) -> bool:
        lacking = self._witness.unmet(expected)
        if not lacking:
            self._witness.forget()
            self._missed = ()
            return True
        if not self._missed or _distance(lacking) <= _distance(self._missed):
            self._missed = lacking
        if now >= self._since + expected.within:
            nearest = self._missed[0]
            self.fail(nearest._replace(expected=f"{nearest.expected} within {expected.within:g} s"))
        return False

    def fail(self, lack: UnmetExpectation) -> None:
        """Record that the story failed at its current step, or its last one if all are done.

        An earlier failure is kept.
        """
        position = min(self.position, len(self.story.steps) - 1)
        self.failed = self.failed or StoryFailure(
            self.story.name, position + 1, self.story.steps[position].where, lack.expected, lack.was
        )


def _distance(lacking: tuple[UnmetExpectation, ...]) -> tuple[bool, int]:
    """Return the distance from meeting an expectation: whether a state is missing, and the number of unmet parts."""
    return any(lack.state for lack in lacking), len(lacking)
