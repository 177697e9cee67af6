"""A whole run, put together: robot, bus, senses, visitor, behaviour, transcript."""

import time
from collections.abc import Callable
from datetime import datetime
from pathlib import Path

from lumen.bus import connect
from lumen.cli.cast import cast
from lumen.cli.reloading import Reloading
from lumen.cli.transcript import Transcript
from lumen.cli.typed import TypedSpeech
from lumen.interpreters.statechart import Step
from lumen.language.commands import Command, Rest
from lumen.language.events import Event
from lumen.language.projects import Project
from lumen.language.stories import Story, Visitor
from lumen.robots.server import Server
from lumen.runtime.exhibition import Exhibition
from lumen.runtime.perception import FaceDetector
from lumen.runtime.story import StoryPlayer
from lumen.runtime.visitor import Walker

FAREWELL = 5.0


class Show:
    """Runs once; `run` returns the exit code."""

    def __init__(
        self,
        project: Project,
        *,
        robot: str,
        speed: str,
        bus_url: str,
        story: Story | None,
        period: float | None,
        language: str,
        video: Path | None,
        watch: bool,
    ) -> None:
        self._story, self._period, self._language = story, period, language
        self._speed = speed
        self._began = time.monotonic()
        self._interrupts = 0
        self._bus = connect(bus_url, project)
        self._cast = cast(robot, project, speed, story)
        self._transcript = Transcript(self._cast.clock.now)
        self._server = Server(project, self._cast.robot, self._bus)
        self._exhibition = Exhibition(
            project,
            self._cast.robot,
            self._bus,
            self._cast.clock,
            observe=self._observe,
            performing=self._performing,
            answered=self._answered,
        )
        self._parts: list[Callable[[float], None]] = self._exhibition.parts
        self._parts.append(self._sense)
        self._player: StoryPlayer | None = None
        self._typed: TypedSpeech | None = None
        self._faces: FaceDetector | None = None
        self._people(project)
        self._closing: list[Callable[[], None]] = [self._server.close, self._bus.close, self._cast.robot.close]
        self._film(video)
        if watch:
            reloading = Reloading(project, self._exhibition, self._transcript)
            self._parts.append(reloading.tick)
            self._closing.insert(0, reloading.close)

    def interrupt(self) -> None:
        """Ctrl-C: once rests the robot, twice ends."""
        self._interrupts += 1
        if self._interrupts == 1:
            self._cast.robot.start("operator", Rest())
            self._transcript.line("operator", "Ctrl-C: the robot rests; again to end")

    def run(self) -> int:
        try:
            self._introduce()
            self._exhibition.start(language=self._language, epoch=self._epoch())
            now = 0.0
            while not self._over(now):
                now = self._exhibition.tick()
        finally:
            for close in self._closing:
                close()
        return self._summary(now)

    def _people(self, project: Project) -> None:
        hall = self._cast.hall
        if hall is None:
            return
        walker = Walker(project, hall, self._bus)
        self._faces = FaceDetector(project, hall, self._bus)
        self._parts += [walker.tick, self._faces.tick]
        if self._story:
            self._player = StoryPlayer(self._story, project, hall, self._bus, walker, self._transcript.deed)
            self._player.attach(self._exhibition)
            self._parts.append(self._player.tick)
        else:
            walker.arrive(Visitor())
            self._typed = TypedSpeech(walker, self._transcript)
            self._parts.append(self._typed.tick)

    def _film(self, video: Path | None) -> None:
        if video:
            from lumen.robots.simulation import SimulatedRobot
            from lumen.robots.simulation.film import Film

            assert isinstance(self._cast.robot, SimulatedRobot)
            film = Film(video, self._cast.robot)
            self._parts.append(film.tick)
            self._closing.insert(0, film.close)

    def _sense(self, now: float) -> None:
        self._server.settle()
        self._server.sample(now)

    def _observe(self, step: Step) -> None:
        self._transcript.observe(step)
        if self._player:
            self._player.observe(step)

    def _performing(self, command: Command, now: float) -> None:
        self._transcript.performing(command, now)
        if self._player:
            self._player.performing(command)

    def _answered(self, event: Event) -> None:
        self._server.answer(event)
        self._transcript.answered(event)
        if self._player:
            self._player.answered(event)

    def _over(self, now: float) -> bool:
        if self._interrupts > 1 or (self._period is not None and now >= self._period):
            return True
        if self._player:
            return self._player.finished
        return self._typed is not None and self._typed.gone_for(now) > FAREWELL

    def _epoch(self) -> float:
        """The local time of day when it starts [s since midnight]."""
        clock = self._story.clock if self._story else ""
        if clock:
            hours, minutes = clock.split(":")
            return int(hours) * 3600.0 + int(minutes) * 60.0
        now = datetime.now()
        return now.hour * 3600.0 + now.minute * 60.0 + now.second

    def _introduce(self) -> None:
        project = self._exhibition.project
        pace = {"max": "as fast as this machine can", "1": "real time"}.get(self._speed, f"{self._speed} × real time")
        took = time.monotonic() - self._began
        print(f"{project.name}: {project.robot} performs `{project.behavior}` at {pace} (ready after {took:.1f} s).")
        if self._story:
            print(f"The story is “{self._story.title}”.\n")
        elif self._typed:
            print("You are the visitor: type what you say. Ctrl-D walks away, Ctrl-C rests the robot, twice ends.\n")

    def _summary(self, now: float) -> int:
        wall = time.monotonic() - self._began
        log, failure = self._transcript, self._player.failure if self._player else ""
        unfinished = self._player is not None and not self._player.finished
        verdict = "The story failed" if failure else "Stopped before the story ended" if unfinished else "All well"
        pace = f"{clock_time(now)} of simulated time, {wall:.0f} s of yours ({now / wall:.1f} × real time)"
        print(f"\n{verdict} after {pace}.")
        if failure:
            print(f"  {failure}")
        print(f"  {len(set(log.states))} states, {log.said} texts said, motions: {', '.join(log.played) or 'none'}")
        print(f"  {self._senses()}")
        print("Next: change a sentence in behaviors/tour.yaml while it runs (docs/change-the-tour.md),")
        print("      `lumen run` to be the visitor yourself, `lumen lint` after every change, `lumen graph` to see it.")
        return 1 if failure else 0

    def _senses(self) -> str:
        counts = ", ".join(f"{count.published} {sense}" for sense, count in self._server.counts.items())
        return f"published: {counts}"


def clock_time(now: float) -> str:
    """`3:07` for 187 [s]."""
    return f"{int(now // 60)}:{int(now % 60):02d}"
