"""A show as it runs on a terminal: introduced, told line by line, summed up."""

import math
import time
from pathlib import Path

from lumen.app.causes import innermost
from lumen.app.garbage import GcScheduler
from lumen.app.modules.in_process import join
from lumen.app.node import Node, film
from lumen.app.processes.claiming import claim, presence_of
from lumen.app.recovery.run_directory import RunDirectory
from lumen.app.reload.reloader import Reloader
from lumen.app.setup import Setup
from lumen.cli.main import STARTED
from lumen.cli.transcript import Transcript
from lumen.cli.typed import TypedSpeech
from lumen.clocks.real import RealClock
from lumen.language.commands import Rest
from lumen.language.events import Event
from lumen.language.modules import EYES, MODULES
from lumen.language.projects import Project
from lumen.language.stories import Arrive, Leave, Story, Visitor, VisitorAction
from lumen.loading.packaged import shipped_root
from lumen.robots.deduplication_log import DEDUPLICATION_FILE, DeduplicationLog
from lumen.robots.sense_publisher import PublishCounts
from lumen.runtime.home import home_of
from lumen.runtime.presence import BRAIN, MOTION, ROBOT, Presence

FAREWELL = 5.0
"""How long it goes on after whoever typed has left [s]."""


class Performance:
    """Runs once; `run` returns the exit code."""

    def __init__(
        self, project: Project, chosen: Setup, bus_url: str, story: Story | None, run_directory: RunDirectory
    ) -> None:
        self._node = Node(project, chosen, bus_url, story, self._visitor_action)
        self._run_directory, self._url = run_directory, bus_url
        self._leaving = False
        self._transcript = Transcript(chosen.clock.now, lambda: self._node.exhibition.project.machine)
        self._node.exhibition.observers.append(self._transcript)
        self._story, self._blind = story, chosen.blind
        self._real = isinstance(chosen.clock, RealClock)
        self._typed: TypedSpeech | None = None
        self._interrupts, self._resting = 0, False
        self._node.exhibition.parts.append(self._rest)
        self._face: float | None = None
        self._presence: Presence | None = None

    def interrupt(self, times: int = 1, *, leave: bool = False) -> None:
        """Ctrl-C: once rests the robot, twice ends. With `leave` the next run goes on where this one ended."""
        self._interrupts += times
        self._leaving = leave

    def _rest(self, now: float) -> None:
        """What the first Ctrl-C asks for, at the tick after it."""
        if self._interrupts and not self._resting:
            self._resting = True
            self._node.robot.start("operator", Rest())
            self._node.exhibition.happen(Event("stop", {}))
            self._transcript.line("operator", "Ctrl-C: the robot rests; again to end")

    def run(
        self, speed: str, period: float | None, language: str, video: Path | None, *, mode: str, fresh: bool
    ) -> int:
        """Perform until the story ends, the period [s] is over, the visitor has left or the operator ends it."""
        show, now = self._node, 0.0
        try:
            if not self._url.startswith("memory:"):
                self._claim()
            if video:
                film(show, video)
            reloading = self._settle(mode)
            self._introduce(speed)
            folder = None if self._story else home_of(self._run_directory.root)
            begun = {module.name for module in join(show, folder, self._transcript.line, paced=speed != "max")}
            if self._presence:
                self._presence.parts = tuple(p for p in self._presence.parts if p not in MODULES or p in begun)
            self._start(reloading, language, fresh=fresh)
            gc_scheduler = GcScheduler()
            show.after.append(gc_scheduler)
            show.closing.append(gc_scheduler.close)
            began = time.monotonic()
            while not self._over(now, period):
                now = show.tick()
            took = time.monotonic() - began
        finally:
            show.close()
        self._run_directory.ended(show.exhibition.project)
        self._run_directory.close(forget=not self._leaving)
        return self._summary(now, took, video)

    def _claim(self) -> None:
        """Be the robot and its brain on that broker. Raises UsageError where somebody else is."""
        show = self._node
        here = tuple(name for name, said in show.exhibition.project.modules.items() if said.here)
        presence = presence_of(show.exhibition.project, show.bus, (ROBOT, BRAIN, MOTION, *here), self._said)
        show.closing.insert(0, presence.close)
        claim(presence)
        if show.server:
            show.server.recall(DeduplicationLog(home_of(self._run_directory.root) / DEDUPLICATION_FILE))
        self._presence = presence
        show.exhibition.parts.append(lambda now: self._meet(presence))

    def _said(self) -> dict[str, str]:
        """What it says of itself to the others on the broker."""
        return {"bundle": self._node.exhibition.project.hash}

    def _meet(self, presence: Presence) -> None:
        """Say that we are here; who has just come is told where the behaviour stands, and the behaviour who is lost."""
        for change in presence.tick():
            self._node.exhibition.happen(change)
            self._transcript.line("others", f"{change.name}, after {change.data['seconds']:.1f} s")
        if self._node.faces and EYES not in presence.parts:
            self._node.faces.quiet = presence.find(EYES) is not None
        if presence.came:
            self._node.trace.standing(self._node.exhibition.runtime.snapshot)

    def _settle(self, mode: str) -> Reloader:
        """Be found by other terminals, and take saved files."""
        show, records = self._node, self._run_directory.records
        self._run_directory.open(show.bus, self._url, show.exhibition.project)
        reloading = Reloader(
            show,
            self._transcript,
            mode=mode,
            records=records,
            applied=self._run_directory.announce,
            seen=self._run_directory.refused,
            apart=True,
        )
        show.exhibition.parts.append(reloading.tick)
        show.closing.insert(0, reloading.close)
        if records.keeper and self._story is None:
            show.after.append(lambda now: records.keep(show.exhibition))
        return reloading

    def _start(self, reloading: Reloader, language: str, *, fresh: bool) -> None:
        """Enter the initial states, or go on where a run ended that nobody meant to end."""
        show = self._node
        found = "" if fresh or self._story else self._run_directory.resumption(show.exhibition.project)
        reloading.begin(self._run_directory.news)
        if isinstance(found, str):
            print(found, end="\n" * bool(found))
            show.start(language)
            return
        states = ", ".join(sorted(innermost(show.exhibition.project.machine, found.snapshot.configuration)))
        print(f"The last run ended without notice {found.away:.0f} s ago: this one goes on from there, in {states}.")
        print(f"`lumen run --fresh` begins anew.{''.join(f' {note}.' for note in found.notes)}")
        show.exhibition.resume(found)

    def _introduce(self, speed: str) -> None:
        project = self._node.exhibition.project
        pace = {"max": "as fast as this machine can", "1": "in real time"}.get(speed, f"at {speed} × real time")
        ready = time.monotonic() - STARTED
        print(f"{project.name}: {project.robot} performs `{project.behavior}` {pace}, ready after {ready:.1f} s.")
        if Path(project.root) == shipped_root() != Path.cwd():
            print(f"There is no lumen.yaml here: this is the shipped project, {project.root}.")
        if self._run_directory.taken:
            print("Another run of this project is going on: `lumen reload` and its like reach that one.")
        if self._blind:
            print(f"It runs without camera images: {self._blind}.")
        if self._story:
            print(f"The story is “{self._story.title}”.\n")
        elif self._node.walker:
            print("You are the visitor: type what you say. Ctrl-D walks away; Ctrl-C rests the robot, twice ends.\n")
            self._node.walker.arrive(Visitor())
            self._visitor_action(Arrive(Visitor()))
            self._typed = TypedSpeech(self._node.walker, self._visitor_action)
            self._node.exhibition.parts.append(self._typed.tick)

    def _visitor_action(self, action: VisitorAction) -> None:
        self._transcript.visitor_action(action)
        faces = self._node.faces
        if isinstance(action, Leave) and faces and faces.last and faces.camera:
            self._face = math.dist(faces.last, (faces.camera.width / 2, faces.camera.height / 2))

    def _over(self, now: float, period: float | None) -> bool:
        if self._interrupts > 1 or (period is not None and now >= period):
            return True
        if self._node.player:
            return self._node.player.finished
        return self._typed is not None and self._typed.gone_for(now) > FAREWELL

    def _summary(self, now: float, took: float, video: Path | None) -> int:
        player, log = self._node.player, self._transcript
        failure = player.failure if player else ""
        early = player is not None and not player.finished
        ended = "The story failed" if failure else "Ended before the story did" if early else "All well"
        pace = "" if self._real else f" in {took:.0f} s ({now / max(took, 0.01):.1f} × real time)"
        print(f"\n{ended}: {clock_time(now)} of {'simulated ' * bool(pace)}time{pace}.")
        if failure:
            print(f"  {failure}")
        print(f"  {len(log.states)} states, {log.said} texts, motions: {', '.join(log.played) or 'none'}")
        if self._face is not None:
            print(f"  the visitor's face ended {self._face:.0f} px from the centre of the camera's image")
        if self._node.server:
            print("  published: " + ", ".join(map(told_count, self._node.server.counts.items())))
        if video:
            print(f"  the film is {video}")
        print(f"Next: change a sentence in behaviors/{self._node.exhibition.project.behavior}.yaml while it runs,")
        print("      `lumen run` to be the visitor yourself, `lumen lint` after every change, `lumen graph` to see it.")
        return 1 if failure or (early and not self._interrupts) else 0


def told_count(item: tuple[str, PublishCounts]) -> str:
    """`1204 joint (3 dropped)`."""
    sense, count = item
    return f"{count.published} {sense}" + (f" ({count.dropped} dropped)" if count.dropped else "")


def clock_time(now: float) -> str:
    """`3:07` for 187 [s]."""
    return f"{int(now // 60)}:{int(now % 60):02d}"
