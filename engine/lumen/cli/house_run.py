"""`lumen run` of several robots: those of `robots:` that are asked for, in one process."""

import argparse
import os
import signal
import time
from collections.abc import Sequence
from functools import partial

from lumen.app.exhibition import Exhibition
from lumen.app.house import House
from lumen.app.house_setup import set_up_house
from lumen.app.node import Node
from lumen.app.parts.console import ConsolePart
from lumen.app.processes.assembling import Plan, ProcessOptions, assemble
from lumen.app.run_start import WHOLE, BegunRun
from lumen.app.setup import Setup
from lumen.bus import connect
from lumen.buses.validated import validated
from lumen.cli.imperfection_options import imperfections_of
from lumen.cli.main import ready
from lumen.cli.printing import clock_time
from lumen.cli.run_choices import alert_desk, chosen_story, language_of, period_of
from lumen.cli.run_verdict import EARLY, FAILED, INTERRUPTED, TROUBLED, WELL, RunVerdict
from lumen.cli.transcript import Transcript
from lumen.cli.typed import TypedVisitorPart
from lumen.clocks.following import FollowingClock
from lumen.errors import LumenError, UsageError
from lumen.language.stories import Story
from lumen.ports import Clock
from lumen.runtime.home import home_of
from lumen.runtime.presence import BRAIN, ROBOT_PART
from lumen.runtime.story import StoryPlayer

ALONE = ("model", "robot_url", "video", "record", "sound")
"""Options that are about one robot."""


class HouseRun:
    """The robots of a house as a terminal runs them; `parts` are those of each that this process is, all without."""

    def __init__(self, options: argparse.Namespace, start: BegunRun, parts: Sequence[str]) -> None:
        self._options, self._start, self._parts = options, start, parts
        self.directories, self.projects = start.directories, start.projects
        robots = tuple(self.projects)
        first = self.projects[robots[0]]
        self.story = chosen_story(first, options.story)
        self.stories: dict[str, Story | None] = dict.fromkeys(robots) | {robots[0]: self.story}
        url = options.bus or os.environ.get("LUMEN_BUS") or first.bus
        self._url = f"memory://house-{os.getpid()}" if url.startswith("memory:") else url
        if parts and url.startswith("memory:"):
            raise UsageError("several processes need a common bus: pass `--bus amqp://USER:PASSWORD@HOST/`")
        self._setups = self._set_up()
        self._player: StoryPlayer | None = None
        self._lost: dict[str, LumenError] = {}
        self._clocks = {name: self._clock(name) for name in robots}
        self.transcripts = {name: self._transcript(name) for name in robots}
        make = self._process if parts else self._whole
        self.nodes: dict[str, Node] = {}
        self.house = House({})
        try:
            for name in robots:
                self.nodes[name] = make(name)
        except BaseException:
            for node in self.nodes.values():
                node.close()
            raise
        self.house = House(self.nodes, self._lose, together=self.story is not None)
        for transcript in self.transcripts.values():
            transcript.unread = lambda: self.house.interrupt(2, leave=True)

    def run(self) -> RunVerdict:
        """Until the story ends, the period is over, or somebody ends it."""
        options, house = self._options, self.house
        signal.signal(signal.SIGINT, lambda *_: house.interrupt())
        signal.signal(signal.SIGTERM, lambda *_: house.interrupt(2, leave=True))
        project = next(iter(self.projects.values()))
        what = ", ".join(self._parts) + " of " if self._parts else ""
        print(f"{project.name}: {what}{', '.join(self.nodes)}, ready after {ready():.1f} s.", flush=True)
        began = time.monotonic()
        try:
            house.start()
            lived = house.run(period_of(options.period))
        finally:
            house.close()
        took = time.monotonic() - began
        nodes = list(self.nodes.values())
        failed, early = any(node.failed for node in nodes), any(node.interrupted for node in nodes)
        failure = self._player.failure if self._player else ""
        told = {name: node.troubles for name, node in self.nodes.items() if not self.stories[name]}
        troubles = [f"{name}: {trouble}" for name, troubles in told.items() for trouble in troubles]
        troubles += [f"{name}: {error}" for name, error in self._lost.items()]
        with_trouble = "Ended with trouble" if troubles else "Ended"
        print(f"\n{'The story failed' if failed else with_trouble}: {clock_time(lived)}.")
        lines = [*RunVerdict.listed(troubles)]
        lines += [f"{name}: {line}" for name, node in self.nodes.items() for line in node.summary()]
        for line in [*([failure] if failure else []), *lines]:
            print(f"  {line}")
        for name, directory in self.directories.items():
            if name not in self._lost and (not self._parts or BRAIN in self._parts):
                directory.ended(self.nodes[name].project)
                directory.close(forget=not self.nodes[name].leaving)
        ended = FAILED if failure else INTERRUPTED if early else EARLY if failed else TROUBLED if troubles else WELL
        return RunVerdict(ended, lived, took, failure or next(iter(troubles), ""), tuple(lines))

    def _set_up(self) -> dict[str, Setup]:
        if self._parts and ROBOT_PART not in self._parts:
            return {}
        lacking = imperfections_of(self._options.imperfections)
        return set_up_house(self._options.robot, self.projects, self._options.speed, self.stories, lacking)

    def _transcript(self, name: str) -> Transcript:
        width = max(map(len, self.projects))
        return Transcript(self._clocks[name].now, lambda: self.nodes[name].project.machine, robot=f"{name:<{width}}")

    def _clock(self, name: str) -> Clock:
        return self._setups[name].clock if self._setups else FollowingClock(float(self._options.speed))

    def _whole(self, name: str) -> Node:
        options, project, directory = self._options, self.projects[name], self.directories[name]
        story, transcript = self.stories[name], self.transcripts[name]
        exhibition = Exhibition(
            project, self._setups[name], self._url, story, transcript,
            run_directory=directory, reload=options.reload, language=language_of(project, options.language),
            fresh=options.fresh or self.story is not None, alerts=alert_desk(project, WHOLE, transcript, self.story),
        )  # fmt: skip
        folder = None if self.story else home_of(directory.root, directory.robot)
        exhibition.node.add_modules(folder, awaited=options.speed == "max")
        first = name == next(iter(self.projects))
        if first and self.story:
            self._player = exhibition.node.player
        elif first and exhibition.node.visitor:
            greeting = f"You are {name}'s visitor: type what you say, or /help. Ctrl-D walks away, Ctrl-C ends.\n"
            exhibition.node.add(TypedVisitorPart(exhibition.node.visitor, transcript, greeting))
        if first and project.console.wanted and options.speed != "max":
            exhibition.node.add(ConsolePart(directory.root, self._url, partial(transcript.line, "console")))
        return exhibition.node

    def _process(self, name: str) -> Node:
        options, project, directory = self._options, self.projects[name], self.directories[name]
        how = ProcessOptions(self._url, float(options.speed), options.reload, options.language or "", options.fresh)
        bus = validated(connect(self._url, sender="+".join(self._parts)), project)
        alerts = alert_desk(project, self._parts, self.transcripts[name], self.story)
        plan = Plan(
            project, self._parts, bus, self._clocks[name], self.transcripts[name], directory, how,
            self._setups.get(name), self.stories[name], alerts,
        )  # fmt: skip
        return assemble(plan)

    def _lose(self, name: str, error: LumenError) -> None:
        """An error ended one robot; the others go on."""
        self._lost[name] = error
        self.transcripts[name].line("trouble", str(error))
        self._start.failures.report(error, [name])


def check_house(options: argparse.Namespace, parts: Sequence[str]) -> None:
    """Raises UsageError for what is about one robot, or does not go with processes."""
    for name in ALONE:
        if getattr(options, name, None):
            flag = name.replace("_", "-")
            raise UsageError(f"--{flag} works with only one robot: choose it with `--robot-name NAME`")
    if options.voice != "none":
        raise UsageError("--voice works with only one robot: choose it with `--robot-name NAME`")
    if parts and options.speed == "max":
        raise UsageError(
            "several processes can run only in real time: leave out --speed max, or run everything in one process"
        )
