"""Plays a story: does what it says, waits for what it expects, and tells where it failed."""

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import assert_never

from lumen.interpreters.statechart import Step
from lumen.language.commands import Command, Play, Publish, Say, Start
from lumen.language.events import Event
from lumen.language.stories import Arrive, Deed, Expect, Happen, Leave, Pause, Send, Speak, Story, Touch
from lumen.ports import Hall
from lumen.runtime.exhibition import Exhibition, Observer
from lumen.runtime.visitor import Walker


@dataclass
class Witness:
    """What has been seen: the states now, and since the last expectation that held what was said, played, published."""

    states: frozenset[str] = frozenset()
    context: dict[str, object] = field(default_factory=dict)
    said: list[str] = field(default_factory=list)
    played: list[str] = field(default_factory=list)
    published: list[str] = field(default_factory=list)
    playing: dict[str, str] = field(default_factory=dict)

    def lacks(self, expected: Expect) -> str:
        """What of `expected` does not hold, in words; empty where all does."""
        if missing := [s for s in expected.states if s not in self.states]:
            return f"state `{missing[0]}`, but active are {_names(self.states)}"
        if expected.said is not None and not any(expected.said.lower() in text.lower() for text in self.said):
            return f"to hear “{expected.said}”, but it said {_texts(self.said)}"
        if expected.played is not None and expected.played not in self.played:
            return f"the motion `{expected.played}`, but it played {_names(self.played)}"
        if expected.published is not None and expected.published not in self.published:
            return f"a message on `{expected.published}`, but it sent {_names(self.published)}"
        for key, value in expected.context.items():
            if self.context.get(key) != value:
                return f"{key} = {value!r}, but it is {self.context.get(key)!r}"
        return ""

    def forget(self) -> None:
        self.said, self.played, self.published = [], [], []


class StoryPlayer(Observer):
    """One story on an exhibition, which it watches; call `tick` with its time.

    It is `finished` when its last step is done or one has failed; `failure` says in a line what was expected where.
    """

    def __init__(
        self,
        story: Story,
        exhibition: Exhibition,
        hall: Hall,
        walker: Walker,
        tell: Callable[[Deed], None] = lambda _: None,
    ) -> None:
        self.story = story
        self.failure = ""
        self.scene = 0
        self._exhibition, self._hall, self._walker = exhibition, hall, walker
        self._tell = tell
        self._witness = Witness()
        self._since = 0.0

    @property
    def finished(self) -> bool:
        return bool(self.failure) or self.scene >= len(self.story.scenes)

    def stepped(self, step: Step) -> None:
        self._witness.states = step.snapshot.configuration
        self._witness.context = dict(step.snapshot.context)
        if bad := self._witness.states.intersection(self.story.never):
            self._fail(f"never state {_names(bad)}, but it was entered")

    def performing(self, command: Command, now: float) -> None:
        match command:
            case Start(_, Say(text)):
                self._witness.said.append(text)
            case Start(id, Play(motion)):
                self._witness.playing[id] = motion
            case Publish(route):
                self._witness.published.append(route)

    def answered(self, event: Event) -> None:
        if event.name.startswith("done.command."):
            motion = self._witness.playing.pop(event.name.removeprefix("done.command."), None)
            if motion:
                self._witness.played.append(motion)

    def tick(self, now: float) -> None:
        """Do every step that can be done by `now` [s]."""
        while not self.finished and self._do(now):
            self.scene += 1
            self._since = now

    def _do(self, now: float) -> bool:
        deed = self.story.scenes[self.scene].deed
        if not isinstance(deed, Pause | Expect):
            self._tell(deed)
        match deed:
            case Pause(seconds):
                return now >= self._since + seconds
            case Expect():
                return self._expect(deed, now)
            case Arrive(visitor):
                self._walker.arrive(visitor)
            case Leave():
                self._walker.leave()
            case Speak(text, language):
                self._walker.speak(text, language)
            case Touch(sensor, pressed):
                self._hall.touch(sensor, pressed)
            case Happen(name, data):
                self._exhibition.happen(Event(name, data, now))
            case Send(name, body):
                project = self._exhibition.project
                self._exhibition.bus.publish(project.routes[name].key_for(project.robot), body)
            case _:
                assert_never(deed)
        return True

    def _expect(self, expected: Expect, now: float) -> bool:
        lacking = self._witness.lacks(expected)
        if not lacking:
            self._witness.forget()
        elif now >= self._since + expected.within:
            self._fail(f"expected within {expected.within:g} s {lacking}")
        return not lacking

    def _fail(self, why: str) -> None:
        self.failure = self.failure or f"step {self.scene + 1} of `{self.story.name}`: {why}"


def _names(names: object) -> str:
    listed = ", ".join(f"`{n}`" for n in sorted(names))  # type: ignore[call-overload]
    return listed or "nothing"


def _texts(texts: list[str]) -> str:
    return "; ".join(f"“{t}”" for t in texts) or "nothing"
