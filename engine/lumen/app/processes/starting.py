"""`lumen run --only robot,motion`: the parts that this process is, chosen and started."""

import argparse
import signal
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from lumen.app.processes.brain import BrainPart
from lumen.app.processes.bundles import Bundles
from lumen.app.processes.claiming import presence_of
from lumen.app.processes.module import ModulePart
from lumen.app.processes.motion import MotionPart
from lumen.app.processes.part import Part
from lumen.app.processes.process import Process
from lumen.app.processes.robot import RobotPart
from lumen.app.processes.visitor import VisitorPart
from lumen.app.recovery.run_directory import RunDirectory
from lumen.app.setup import Setup, set_up
from lumen.bus import connect
from lumen.buses.validated import ValidatedBus, validated
from lumen.cli.transcript import Transcript
from lumen.clocks.real import RealClock
from lumen.errors import UsageError
from lumen.language.modules import MODULES
from lumen.language.projects import Project
from lumen.language.stories import Story
from lumen.ports import Clock
from lumen.runtime.home import home_of
from lumen.runtime.presence import BRAIN, MOTION, ROBOT, VISITOR


def start(
    options: argparse.Namespace,
    project: Project,
    story: Story | None,
    parts: Sequence[str],
    url: str,
    run_directory: RunDirectory,
    period: float | None,
    language: str,
) -> int:
    """Run these parts of an exhibition; the exit code. Raises UsageError for options that do not go with that."""
    _check(options, story, parts, url)
    speed = float(options.speed)
    chosen = set_up(options.robot, project, options.speed, story, options.robot_url) if ROBOT in parts else None
    clock: Clock = chosen.clock if chosen else RealClock(speed=speed)
    bus = validated(connect(url), project)
    process, brain = assembled(options, project, story, parts, (bus, url), run_directory, language, clock, chosen)
    if chosen and (options.voice != "none" or options.sound):
        from lumen.app.voice import voiced  # nobody else needs espeak-ng

        process.closing.append(voiced(chosen, options.voice, options.sound, language or project.languages[0]))
    signal.signal(signal.SIGINT, lambda *_: process.interrupt())
    signal.signal(signal.SIGTERM, lambda *_: process.interrupt(2, leave=True))
    code = process.run(period)
    if brain:
        run_directory.ended(brain.project)
        run_directory.close(forget=not process.leaving)
    return code


def assembled(
    options: argparse.Namespace,
    project: Project,
    story: Story | None,
    names: Sequence[str],
    way: tuple[ValidatedBus, str],
    run_directory: RunDirectory,
    language: str,
    clock: Clock,
    chosen: Setup | None,
) -> tuple[Process, BrainPart | None]:
    """The process with its parts, and its brain where it is one."""
    bus, url = way
    parts: list[Part] = []
    robot: RobotPart | None = None
    brain: BrainPart | None = None
    running = [project]

    def said() -> dict[str, Any]:
        bundle = brain.project if brain else running[0]
        follows = robot.follows if robot else ""
        return {"bundle": bundle.hash, "speed": float(options.speed), "follows": follows}

    presence = presence_of(project, bus, tuple(names), said)
    transcript = Transcript(clock.now, lambda: (brain.project if brain else running[0]).machine)
    if chosen:
        parts.append(robot := RobotPart(project, bus, chosen, presence, transcript))
    if MOTION in names:
        parts.append(MotionPart(project, bus, clock, presence, transcript))
    if BRAIN in names:
        mode = options.reload
        brain = BrainPart(
            project, bus, url, clock, presence, run_directory, transcript, story,
            mode=mode, language=language, fresh=options.fresh, speed=float(options.speed),
        )  # fmt: skip
        parts.append(brain)
    if VISITOR in names:
        parts.append(VisitorPart(project, bus, transcript, story, telling=BRAIN not in names))
    tell = transcript.line
    parts += [ModulePart(n, project, bus, tell, home_of(run_directory.root)) for n in names if n in MODULES]
    process = Process(project, bus, url.rpartition("@")[2], clock, presence, parts, float(options.speed))

    def use(other: Project) -> None:
        running[0] = other
        process.use(other)

    if set(names) != {BRAIN}:  # which sees to its files by itself
        bundles = Bundles(Path(project.root), bus, use, lambda line: transcript.line("reload", line))
        process.after.append(bundles.tick)
        process.closing.append(bundles.close)
    return process, brain


def _check(options: argparse.Namespace, story: Story | None, parts: Sequence[str], url: str) -> None:
    if url.startswith("memory:"):
        raise UsageError("processes need a bus that they can all reach: say --bus amqp://USER:PASSWORD@HOST/")
    if options.speed == "max":
        raise UsageError("processes live in one time, which is real: --speed max needs everything in one of them")
    if options.video:
        raise UsageError("--video films an exhibition in one process: leave out --only")
    if options.robot == "none" and ROBOT in parts:
        raise UsageError("`--only robot` needs a robot: leave out --robot none")
    if story and story.robot and ROBOT not in parts:
        raise UsageError(f"`{story.name}` says with `robot:` what fails: give it to the robot's process, too")
