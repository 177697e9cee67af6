"""A script played on the recording robot, with the robot's observable actions tick by tick."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any

from lumen.insight.replay.against import noticed
from lumen.language.command_data import command_data
from lumen.language.commands import Command, Play, Publish, Say, Start
from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.language.stories import Story
from lumen.run.loop import Observer
from lumen.run.rehearsal import Rehearsal, rehearse
from lumen.statechart import Step
from lumen.statechart.nesting import active_names, entered_names


@dataclass
class TickNotes:
    """The observations in one tick."""

    at: float
    """The time of the tick [s]."""
    active: frozenset[str] = frozenset()
    """The states that are active at the end of the tick."""
    entered: list[str] = field(default_factory=list)
    """The states that were entered."""
    said: list[str] = field(default_factory=list)
    """The texts that the robot began to say."""
    played: list[str] = field(default_factory=list)
    """The motions that ended."""
    published: list[str] = field(default_factory=list)
    """The routes of messages that were sent."""

    def __bool__(self) -> bool:
        return bool(self.entered or self.said or self.played or self.published)


@dataclass
class Rendition:
    """The course of a story."""

    rehearsal: Rehearsal
    ticks: list[TickNotes]
    """The ticks in which something was observed."""
    acted: list[float]
    """The times of the visitor's actions [s]."""
    told: list[str]
    """The robot's observable actions, in words."""


def played(project: Project, story: Story) -> Rendition:
    """Play a story to its end or failure; return its course."""
    watch = _Watch()
    rehearsal = rehearse(project, story, observers=[watch], hooks=[watch.tick], whole=True)
    acted = [at for at, who, _ in rehearsal.trace if who in ("visitor", "story")]
    return Rendition(rehearsal, list(watch.ticks()), acted, told(watch.commands))


def told(commands: Sequence[tuple[float, Any]]) -> list[str]:
    """Return the observable effects of commands, in words."""
    return [words for _, words, _ in noticed(list(commands))]


class _Watch(Observer):
    def __init__(self) -> None:
        self._ticks = [TickNotes(0.0)]
        self._playing = dict[str, str]()
        self.commands = list[tuple[float, Any]]()

    def ticks(self) -> Iterator[TickNotes]:
        return filter(None, self._ticks)

    def tick(self, now: float) -> None:
        if not self._ticks[-1]:
            self._ticks.pop()
        self._ticks.append(TickNotes(now))

    def stepped(self, step: Step) -> None:
        notes = self._ticks[-1]
        notes.active = active_names(step.snapshot)
        notes.entered += entered_names(step)
        if step.event:
            self.commands += ((step.snapshot.at, command_data(command)) for command in step.commands)

    def performing(self, command: Command, now: float) -> None:
        notes = self._ticks[-1]
        match command:
            case Start(_, Say(text)):
                notes.said += [text] if text else []
            case Start(id, Play(motion)):
                self._playing[id] = motion
            case Publish(route):
                notes.published.append(route)

    def answered(self, event: Event) -> None:
        kind, _, id = event.name.partition(".command.")
        if (motion := self._playing.pop(id, "")) and kind == "done":
            self._ticks[-1].played.append(motion)
