"""`lumen run` of several robots of `robots:` in one process."""

import argparse
import os
import time
from collections.abc import Sequence
from contextlib import ExitStack, closing
from pathlib import Path

from lumen.bus.addresses import within_process
from lumen.cli.main import ready
from lumen.cli.printing import clock_time
from lumen.cli.run_choices import chosen_story, period_of, robot_wishes
from lumen.cli.run_plan import RobotRun, bus_hint, compose_or_hint, heed_signals, leave, plan_of
from lumen.cli.run_verdict import FAILED, RunVerdict, end_of, troubles_of
from lumen.cli.transcript import Transcript
from lumen.clock.following import FollowingClock
from lumen.errors import LumenError, UsageError
from lumen.language.projects import Project
from lumen.language.stories import Story
from lumen.ports import Clock
from lumen.run.house import House
from lumen.run.loudspeaker import sounding
from lumen.run.plan import Plan
from lumen.run.presence import BRAIN, ROBOT_PART
from lumen.run.run_start import BegunRun
from lumen.run.services import Services
from lumen.run.setup import Setup, robot_options, set_up_house


class HouseRun:
    """The robots of a house, run from one terminal.

    `parts` are the parts of each robot that this process runs; empty means all. Making a HouseRun composes their
    exhibitions. Raises UsageError if several processes have no common bus.
    """

    def __init__(self, options: argparse.Namespace, start: BegunRun, parts: tuple[str, ...]) -> None:
        self._options, self._start, self._parts = options, start, parts
        self.directories, self.projects = start.directories, start.projects
        robots = tuple(self.projects)
        self._first = robots[0]
        self.story = chosen_story(self.projects[self._first], options, parts)
        self.stories: dict[str, Story | None] = dict.fromkeys(robots) | {self._first: self.story}
        url = options.bus or os.environ.get("LUMEN_BUS") or self.projects[self._first].bus
        if parts and within_process(url):
            raise UsageError("several processes need a common bus: pass `--bus amqp://USER:PASSWORD@HOST/`")
        self._url = f"{url.partition(':')[0]}://house-{os.getpid()}" if within_process(url) else url
        self._setups = self._set_up()
        self._lost: dict[str, LumenError] = {}
        self._clocks = {name: self._clock(name) for name in robots}
        self.transcripts = {name: self._transcript(name) for name in robots}
        self.made: dict[str, Services] = {}
        with ExitStack() as undo:
            for name in robots:
                self.made[name] = compose_or_hint(self._plan(name), bus_hint(options) if parts else "")
                undo.callback(self.made[name].node.close)
            undo.pop_all()
        self.house = House(self.made, self._lose, together=self.story is not None)

    def run(self) -> RunVerdict:
        """Run until the story ends, the period is over, or the operator ends it.

        Print a summary and return the verdict.
        """
        options, house = self._options, self.house
        heed_signals([*self.made.values()])
        project = next(iter(self.projects.values()))
        what = ", ".join(self._parts) + " of " if self._parts else ""
        print(f"{project.name}: {what}{', '.join(house.nodes)}, ready after {ready():.1f} s.", flush=True)
        began = time.monotonic()
        robots = [setup.robot for setup in self._setups.values()]
        with sounding(robots, Path(project.root), audible=options.speed != "max"), closing(house):
            house.start()
            lived = house.run(period_of(options.period))
        took = time.monotonic() - began
        of_parts = [f"{name}: {line}" for name, node in house.nodes.items() for line in node.summary()]
        told = {name: troubles_of(node, judged=self.stories[name] is not None) for name, node in house.nodes.items()}
        troubles = [f"{name}: {trouble}" for name, troubles in told.items() for trouble in troubles]
        troubles += [f"{name}: {error}" for name, error in self._lost.items()]
        end = end_of([*self.made.values()], troubles)
        print(f"\n{end.words}: {clock_time(lived)}.")
        lines = [*RunVerdict.listed(troubles), *of_parts]
        for line in [*([end.failure] if end.ended == FAILED and not self._parts else []), *lines]:
            print(f"  {line}")
        for name, directory in self.directories.items():
            if name not in self._lost and (not self._parts or BRAIN in self._parts):
                directory.ended(house.nodes[name].project)
                directory.close(forget=not house.nodes[name].leaving)
        return RunVerdict(end.ended, lived, took, end.failure, tuple(lines))

    def _set_up(self) -> dict[str, Setup]:
        if self._parts and ROBOT_PART not in self._parts:
            return {}
        options = robot_wishes(self._options)
        return set_up_house(self._options.robot, self.projects, self._options.speed, self.stories, options)

    def _transcript(self, name: str) -> Transcript:
        width = max(map(len, self.projects))
        return Transcript(
            self._clocks[name].now,
            lambda: self._running(name).machine,
            robot=f"{name:<{width}}",
            unread=lambda: leave(self.made.values()),
        )

    def _running(self, name: str) -> Project:
        return self.made[name].project if name in self.made else self.projects[name]

    def _clock(self, name: str) -> Clock:
        return self._setups[name].clock if self._setups else FollowingClock(float(self._options.speed))

    def _plan(self, name: str) -> Plan:
        first = name == self._first
        one = RobotRun(self.projects[name], self.directories[name], self.stories[name], first)
        greeting = f"You are {name}'s visitor: type what you say, or /help. Ctrl-D walks away, Ctrl-C ends.\n"
        typed = greeting if first and not self._parts else ""
        setup, clock, transcript = self._setups.get(name), self._clocks[name], self.transcripts[name]
        return plan_of(self._options, one, self._parts, self._url, setup, clock, transcript, greeting=typed)

    def _lose(self, name: str, error: LumenError) -> None:
        """Record the error that ended one robot; the other robots continue."""
        self._lost[name] = error
        self.transcripts[name].line("trouble", str(error))
        self._start.failures.report(error, [name])


def check_house(options: argparse.Namespace, parts: Sequence[str]) -> None:
    """Raise UsageError for options that work with only one robot, or not with several processes."""
    own = (option.destination for option in robot_options() if not option.several)
    for name in ("model", *own, "record", "sound"):
        if vars(options)[name]:
            flag = name.replace("_", "-")
            raise UsageError(f"--{flag} works with only one robot: choose it with `--robot-name NAME`")
    if options.voice != "none":
        raise UsageError("--voice works with only one robot: choose it with `--robot-name NAME`")
    if parts and options.speed == "max":
        raise UsageError(
            "several processes can run only in real time: leave out --speed max, or run everything in one process"
        )
