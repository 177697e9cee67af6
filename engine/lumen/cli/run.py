"""`lumen run`: an exhibition, in one process or in several."""

import argparse
import os
import signal
from collections.abc import Callable
from pathlib import Path

from lumen.app.processes.choosing import parts_of
from lumen.app.recovery.run_directory import RunDirectory
from lumen.app.recovery.startup import startup_project
from lumen.app.reload.reloader import MODES
from lumen.app.setup import ROBOTS, SPEEDS, VOICES, Setup, set_up
from lumen.app.stories import home_of, stories_of
from lumen.cli.performance import Performance
from lumen.errors import BusError, ModuleError, RobotError, UsageError
from lumen.language.diagnostics import did_you_mean
from lumen.language.projects import Project
from lumen.language.stories import Story
from lumen.loading.packaged import find_project
from lumen.loading.units import seconds


def configure(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add("project", nargs="?", metavar="PROJECT", help="its folder; default: here or above, else the shipped one")
    add("--story", metavar="STORY", help="a scripted visitor of behaviors/stories/; without one, you type what you say")
    add("--robot", choices=ROBOTS, default="simulation", help="who performs it (default: simulation)")
    add(
        "--only",
        metavar="PARTS",
        help="one process of several: robot, brain, motion, visitor, memory, eyes, ears, voice, social; commas between",
    )
    add("--robot-url", metavar="URL", help="where the real one is (--robot naoqi); default: tcp://nao.local:9559")
    add("--speed", choices=SPEEDS, default="1", help="simulated time, times real time (default: 1)")
    add("--bus", metavar="URL", help="memory:// or amqp://user:password@host/ (default: LUMEN_BUS, then lumen.yaml's)")
    add("--for", dest="period", metavar="60s", help="end after so much simulated time")
    add("--language", metavar="LANG", help="which language it speaks first")
    add("--video", metavar="FILE.mp4", type=Path, help="write a film of the run (simulation, needs OpenGL)")
    add("--voice", choices=VOICES, default="none", help="let espeak-ng say the simulated robot's texts (default: none)")
    add("--sound", metavar="FILE.wav", type=Path, help="with --voice: write what is said instead of playing it")
    add("--reload", choices=MODES, default="auto", help="take saved files while it runs, or wait for `lumen reload`")
    add("--last-good", action="store_true", help="where the files have errors, start with the last that had none")
    add("--fresh", action="store_true", help="begin anew, even where the last run ended without notice")


def run(options: argparse.Namespace) -> int:
    named = () if options.story is None else (options.story,)
    root = find_project(options.project or home_of(named))
    parts = parts_of(options.only, options.robot)
    run_directory = RunDirectory(root, guest=bool(parts) and "brain" not in parts)
    try:
        return _run(options, root, run_directory, parts)
    except (BusError, RobotError, ModuleError):
        run_directory.records.annul()
        raise
    finally:
        run_directory.close(forget=False)


def _run(options: argparse.Namespace, root: Path, run_directory: RunDirectory, parts: tuple[str, ...]) -> int:
    project = startup_project(root, run_directory, last_good=options.last_good)
    story = _story(project, options.story)
    if story and story.robot and options.robot != "recording" and "robot" in (parts or ("robot",)):
        raise UsageError(f"`{story.name}` says with `robot:` what fails; only --robot recording plays it")
    if story and options.robot == "none":
        raise UsageError("a story needs a robot in a hall: leave out --robot none")
    period, language = _period(options.period), _language(project, options.language)
    url = options.bus or os.environ.get("LUMEN_BUS") or project.bus
    if parts:
        from lumen.app.processes.starting import start  # not needed for an exhibition in one process

        return start(options, project, story, parts, url, run_directory, period, language)
    video = film_path(options.video, options.robot)
    chosen = set_up(options.robot, project, options.speed, story, options.robot_url)
    silence = _voice(options, chosen, language or project.languages[0])
    performance = Performance(project, chosen, url, story, run_directory)
    signal.signal(signal.SIGINT, lambda *_: performance.interrupt())
    signal.signal(signal.SIGTERM, lambda *_: performance.interrupt(2, leave=True))
    try:
        return performance.run(options.speed, period, language, video, mode=options.reload, fresh=options.fresh)
    finally:
        silence()


def _voice(options: argparse.Namespace, chosen: Setup, language: str) -> Callable[[], None]:
    """Give the robot the voice that the flags ask for; what ends it. Raises UsageError or ModuleError."""
    if options.voice == "none" and not options.sound:
        return lambda: None
    from lumen.app.voice import voiced  # nobody else needs espeak-ng

    return voiced(chosen, options.voice, options.sound, language)


def _story(project: Project, name: str | None) -> Story | None:
    if name is None:
        return None
    found = list(stories_of(project, name))
    if len(found) > 1:
        raise UsageError(f"one story at a time: `{name}` means `{found[0].name}`, `{found[1].name}` and more")
    return found[0]


def _period(text: str | None) -> float | None:
    if text is None:
        return None
    period = seconds(text)
    if period is None:
        raise UsageError(f"--for takes a duration such as 60s or 2min, not `{text}`")
    return period


def _language(project: Project, language: str | None) -> str:
    if language is not None and language not in project.languages:
        hint = did_you_mean(language, project.languages, "it speaks")
        raise UsageError(f"the project does not speak `{language}`: {hint}")
    return language or ""


def film_path(path: Path | None, robot: str) -> Path | None:
    """Where a film may be written; raises UsageError where it may not."""
    if path is None:
        return None
    if robot != "simulation":
        raise UsageError("--video films the simulation: leave out --robot")
    if path.suffix != ".mp4" or not path.parent.is_dir() or not os.access(path.parent, os.W_OK):
        raise UsageError(
            f"can't write a film to {path}: name an .mp4 file in a folder that is there and yours to write"
        )
    return path
