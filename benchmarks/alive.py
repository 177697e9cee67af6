"""Measure how alive the robot looks: the share of the shipped tour without any movement, from the joints on the bus.

    python benchmarks/alive.py [--without] [STORY]

A joint has moved if its angle, in the encoders' steps of 0.1 degrees, differs from that of the message before. The
simulated encoders have no noise, which would count as movement. `--without` plays the same tour without idle life.
"""

import argparse
import platform
from collections.abc import Iterator, Sequence
from dataclasses import replace
from math import degrees
from pathlib import Path
from time import process_time
from typing import Any

import lumen
from lumen.bus.memory import MemoryBus
from lumen.features.simulation.offers import SimulatedRobot
from lumen.features.simulation.settings import PERFECT
from lumen.language.commands import Command, Play, Say, Start
from lumen.language.events import Event
from lumen.language.gestures import merged
from lumen.language.projects import Project
from lumen.ports import Message
from lumen.project.lending import model_files
from lumen.robot.command_table import speech_duration
from lumen.robot.gesture_player import GesturePlayer
from lumen.robot.life_layer import LifeLayer
from lumen.run.exhibition import Exhibition
from lumen.run.loop import Observer
from lumen.run.plan import Plan
from lumen.run.setup import set_up_with

ROOT = Path(__file__).parents[1]
STEP = 0.1
"""Resolution of an encoder [degrees]."""

TICKS = 20_000


class Movement:
    """Adds up the time in which none of some joints moved while the robot was awake [s]."""

    def __init__(self, chosen: Sequence[str] = ()) -> None:
        """Watch the `chosen` joints, or all if there are none."""
        self.chosen = chosen
        self.time = self.still = self.longest = 0.0
        self._last: tuple[float, tuple[int, ...]] | None = None
        self._since = 0.0

    def see(self, body: dict[str, Any], counts: bool) -> None:
        """Process a message of the sense `joint`; it `counts` if the robot is awake and the moment is measured."""
        at, angles = float(body["time"]), dict(zip(body["name"], body["angle"], strict=True))
        stands = tuple(round(degrees(angles[name]) / STEP) for name in (self.chosen or angles))
        if not counts:
            self._last, self._since = None, at
            return
        if self._last is not None:
            passed = at - self._last[0]
            self.time += passed
            if stands == self._last[1]:
                self.still += passed
                self.longest = max(self.longest, at - self._since)
            else:
                self._since = at
        else:
            self._since = at
        self._last = at, stands

    def __str__(self) -> str:
        share = 100 * self.still / self.time if self.time else 0.0
        return f"{share:5.1f} % of {self.time:.0f} s without movement, {self.longest:.2f} s at most"


class Motions(Observer):
    """Collects the motions that play and the texts that are said."""

    def __init__(self) -> None:
        self.playing: set[str] = set()
        self.texts: list[Say] = []

    def performing(self, command: Command, now: float) -> None:
        """Track the motions that play, and collect the texts."""
        match command:
            case Start(id, Play()):
                self.playing.add(id)
            case Start(_, Say() as said):
                self.texts.append(said)

    def answered(self, event: Event) -> None:
        """Remove a motion that has ended."""
        self.playing.discard(event.name.partition(".command.")[2])


def measured(project: Project, name: str) -> tuple[Movement, Movement, Movement, Sequence[Say]]:
    """Return the movements of the robot in a simulated story, and the texts that it says.

    The movements are those of all joints; of arms and legs; and of the head, the latter two only while no motion plays.
    """
    parts, bus, motions = project.body.parts, MemoryBus(), Motions()
    whole, trunk, head = Movement(), Movement([*parts["arms"], *parts["legs"]]), Movement(parts["head"])

    def see(message: Message) -> None:
        awake = max(message.body["stiffness"]) > 0.5
        whole.see(message.body, awake)
        for part in (trunk, head):
            part.see(message.body, awake and not motions.playing)

    robot = SimulatedRobot(project.body, *model_files(project), stage=project.stage, imperfections=PERFECT)
    bus.subscribe(project.routes["joint"].key_for(project.robot), see)
    with Exhibition(Plan(project, set_up_with(robot), bus, project.stories[name])) as exhibition:
        exhibition.loop.observers.append(motions)
        while not exhibition.player.finished:
            exhibition.tick()
    return whole, trunk, head, motions.texts


def main() -> None:
    parser = argparse.ArgumentParser()
    parser.add_argument("story", nargs="?", default="visitor")
    parser.add_argument("--without", action="store_true")
    given = parser.parse_args()
    project = lumen.load(ROOT)
    if given.without:
        project = replace(project, life={}, gestures={})
    begin = process_time()
    whole, trunk, head, texts = measured(project, given.story)
    how = "without life" if given.without else "alive"
    print(f"{given.story}, simulated, {how}; {platform.machine()}, Python {platform.python_version()}")
    print(f"all joints               {whole}")
    print(f"arms and legs, no motion {trunk}")
    print(f"head, no motion          {head}")
    print(f"CPU of the whole         {process_time() - begin:.1f} s")
    _gestures(project, texts)
    _cost(project)


def _threes(drawn: Sequence[Sequence[str]]) -> Iterator[Sequence[Sequence[str]]]:
    return (drawn[i : i + 3] for i in range(len(drawn) - 2))


def _gestures(project: Project, texts: Sequence[Say]) -> None:
    """Print how many texts have gestures, and how often a gesture is repeated within three texts."""
    player = GesturePlayer(project.body)
    player.library = merged(project.gestures)
    drawn = [player.say(text, speech_duration(text.text), 0.0) for text in texts]
    soon = sum(bool(set(now) & {*before, *earlier}) for earlier, before, now in _threes(drawn))
    kinds = {name for names in drawn for name in names}
    print(
        f"gestures                 {sum(map(bool, drawn))} of {len(texts)} texts, {sum(map(len, drawn))} gestures "
        f"({len(kinds)} different), {soon} twice within three texts"
    )


def _cost(project: Project) -> None:
    """Print the processor time of idle life in a control period."""
    for name, style in project.life.items():
        layer = LifeLayer(project.body)
        layer.style = style
        free = frozenset(project.body.parts)
        begin = process_time()
        for tick in range(TICKS):
            layer.advance(tick / 100, 0.01, free, lambda _part: 1.0)
        print(f"a tick of 10 ms, {name:<10} {1e6 * (process_time() - begin) / TICKS:5.1f} us of CPU")


if __name__ == "__main__":
    main()
