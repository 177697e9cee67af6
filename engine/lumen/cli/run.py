"""`lumen run`: an exhibition, in one process or in several."""

import argparse
import os
import signal
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, nullcontext, suppress
from functools import partial
from pathlib import Path

from lumen.app.exhibition import Exhibition
from lumen.app.loudspeaker import Loudspeaker, Sounds
from lumen.app.node import Node
from lumen.app.one_robot import robots_of
from lumen.app.parts.console import ConsolePart
from lumen.app.parts.visitor import VisitorPart
from lumen.app.processes.assembling import Plan, ProcessOptions, assemble
from lumen.app.processes.choosing import parts_of
from lumen.app.recovery.run_directory import RunDirectory
from lumen.app.reload.reloader import MODES
from lumen.app.run_start import WHOLE, BegunRun, started
from lumen.app.setup import ROBOTS, SPEEDS, VOICES, Setup
from lumen.app.stories import home_of
from lumen.bus import connect
from lumen.buses.validated import validated
from lumen.cli.film_options import configure_size, film_path, film_progress, film_size
from lumen.cli.formats import configure_format, one_object
from lumen.cli.imperfection_options import configure_imperfections, set_up_robot
from lumen.cli.main import ready
from lumen.cli.model_option import configure_model, use_model
from lumen.cli.performance import Performance
from lumen.cli.printing import clock_time
from lumen.cli.run_choices import alert_desk, chosen_story, language_of, period_of
from lumen.cli.run_verdict import FAILED, INTERRUPTED, TROUBLED, WELL, RunVerdict
from lumen.cli.streams import complain
from lumen.cli.transcript import Transcript
from lumen.cli.typed import TypedVisitorPart
from lumen.clocks.following import FollowingClock
from lumen.errors import BusUnreachableError, UsageError
from lumen.language.projects import Project
from lumen.language.stories import Story
from lumen.loading.running_project import is_substituted, project_to_run
from lumen.modules.audio_track import AudioTrack
from lumen.ports import Clock
from lumen.runtime.home import home_of as home_of_run
from lumen.runtime.inputs.journal_folder import JOURNAL_FOLDER
from lumen.runtime.presence import BRAIN, ROBOT_PART
from lumen.upkeep.heap import give_back

PRIORITY = -10
"""Of an exhibition in real time, as `nice` counts: that takes root, or a right such as systemd's `LimitNICE=-10`."""


def configure(parser: argparse.ArgumentParser) -> None:
    add = parser.add_argument
    add(
        "project",
        nargs="?",
        metavar="PROJECT",
        help="the project's folder (default: this folder or one above, else the shipped project)",
    )
    add(
        "--story",
        metavar="STORY",
        help="play a story from behaviors/stories/ (default: you are the visitor and type what you say)",
    )
    configure_model(parser)
    add("--robot-name", metavar="NAMES", help="robots in `robots:`, separated by commas (default: all)")
    add(
        "--robot",
        choices=ROBOTS,
        default="simulation",
        help="the robot that performs the exhibition (default: simulation)",
    )
    add(
        "--only",
        metavar="PARTS",
        help="run only these parts, separated by commas: robot, brain, motion, visitor, memory, eyes, ears, voice,"
        " social, show, answers",
    )
    add("--robot-url", metavar="URL", help="with --robot naoqi: the robot's address (default: tcp://nao.local:9559)")
    add("--speed", choices=SPEEDS, default="1", help="speed of simulated time, as a multiple of real time (default: 1)")
    add("--bus", metavar="URL", help="memory:// or amqp://user:password@host/ (default: LUMEN_BUS, then lumen.yaml)")
    add("--for", dest="period", metavar="60s", help="end after this much simulated time")
    add("--language", metavar="LANG", help="the language that the robot speaks first")
    add("--video", metavar="FILE.mp4", type=Path, help="save a video of the run (simulation only; needs OpenGL)")
    configure_size(parser)
    configure_imperfections(parser)
    add("--record", metavar="FILE.mcap", type=Path, help="record the messages on the bus, for Foxglove and Lichtblick")
    add(
        "--voice",
        choices=VOICES,
        default="none",
        help="speak the simulated robot's texts with espeak-ng (default: none)",
    )
    add("--sound", metavar="FILE.wav", type=Path, help="with --voice: write the speech to a file instead of playing it")
    add(
        "--reload",
        choices=MODES,
        default="auto",
        help="use saved files at once, at `lumen reload`, or never (default: auto)",
    )
    add("--last-good", action="store_true", help="if the files have errors, start with the last ones that had none")
    add("--fresh", action="store_true", help="start from the beginning, even if the last run ended unexpectedly")
    configure_format(parser)


def run(options: argparse.Namespace) -> int:
    give_back()
    named = () if options.story is None else (options.story,)
    path = options.project or home_of(named)
    root = project_to_run(path)
    use_model(options.model, [root])
    if is_substituted(path):
        journal = home_of_run(root) / JOURNAL_FOLDER
        complain(
            f"There is no lumen.yaml here or above: Lumen runs a copy of its own exhibition, {root}. Its journal is"
            f" {journal}. `lumen new DIR` makes a project of your own."
        )
    parts, robots = parts_of(options.only, options.robot), robots_of(root, options.robot_name)
    if len(robots) > 1:
        from lumen.cli.house_run import check_house  # nobody else needs it

        check_house(options, parts)
    with (
        one_object(options.format) as say,
        nullcontext() if options.speed == "max" else _going_first(),
        started(root, robots, parts, last_good=options.last_good, alerted=not options.story, tell=complain) as start,
    ):
        verdict = _house(options, start, parts) if len(robots) > 1 else _run(options, start, parts)
        say(verdict.to_json(str(root.absolute()), options.story))
        return verdict.code


def _house(options: argparse.Namespace, start: BegunRun, parts: tuple[str, ...]) -> RunVerdict:
    """Run several robots in this process."""
    from lumen.cli.house_run import HouseRun  # nobody else needs it

    return HouseRun(options, start, parts).run()


def _run(options: argparse.Namespace, start: BegunRun, parts: tuple[str, ...]) -> RunVerdict:
    (project,), (run_directory,) = start.projects.values(), start.directories.values()
    story = chosen_story(project, options.story)
    if story and story.robot and options.robot != "recording" and "robot" in (parts or ("robot",)):
        raise UsageError(f"the story `{story.name}` has faults of the robot (`robot:`): play it with --robot recording")
    if story and options.robot == "none":
        raise UsageError("a story needs a robot: leave out --robot none")
    period, language = period_of(options.period), language_of(project, options.language)
    url = options.bus or os.environ.get("LUMEN_BUS") or project.bus
    if parts:
        return _processes(options, project, story, parts, url, run_directory, period, language)
    return _whole(options, project, story, url, run_directory, period, language)


def _whole(
    options: argparse.Namespace,
    project: Project,
    story: Story | None,
    url: str,
    run_directory: RunDirectory,
    period: float | None,
    language: str,
) -> RunVerdict:
    """Run a whole exhibition in this process."""
    video, size = film_path(options.video, options.robot), film_size(options.size)
    setup = set_up_robot(options, project, story)
    track = AudioTrack() if video else None
    silence = _voice(options, setup, language or project.languages[0], track)
    quiet = _sounding(options, project, setup, track)
    performance = Performance(setup, lambda: exhibition.project)
    try:
        exhibition = Exhibition(
            project, setup, url, story, performance.transcript,
            run_directory=run_directory, reload=options.reload, language=language, fresh=options.fresh,
            alerts=alert_desk(project, WHOLE, performance.transcript, story), record=options.record,
        )  # fmt: skip
        node = exhibition.node
        performance.transcript.unread = lambda: node.interrupt(2, leave=True)
        _heed_signals(node)
        try:
            if video:
                node.add_film(video, track, size=size, progress=film_progress(project, story, period))
            if project.console.wanted and options.speed != "max":
                node.add(ConsolePart(run_directory.root, url, partial(performance.transcript.line, "console")))
            node.claim()
            performance.introduce(exhibition, run_directory, options.speed)
            folder = None if story else home_of_run(run_directory.root, run_directory.robot)
            node.add_modules(folder, awaited=options.speed == "max")
            exhibition.start()
            performance.run(exhibition, period)
        finally:
            exhibition.close()
        run_directory.ended(exhibition.project)
        run_directory.close(forget=not node.leaving)
        return performance.summary(exhibition, video)
    finally:
        quiet()
        silence()


def _processes(
    options: argparse.Namespace,
    project: Project,
    story: Story | None,
    parts: Sequence[str],
    url: str,
    run_directory: RunDirectory,
    period: float | None,
    language: str,
) -> RunVerdict:
    """Run these parts of an exhibition. Raises UsageError for options that do not go with that."""
    _check_processes(options, story, parts, url)
    setup = set_up_robot(options, project, story) if ROBOT_PART in parts else None
    speed = float(options.speed)
    clock: Clock = setup.clock if setup else FollowingClock(speed)
    transcript = Transcript(clock.now, lambda: node.project.machine)
    how = ProcessOptions(url, speed, options.reload, language, options.fresh)
    try:
        bus = validated(connect(url, sender="+".join(parts)), project)
    except BusUnreachableError as error:
        raise error if options.only else BusUnreachableError(f"{error}, or use --bus memory://") from None
    alerts = alert_desk(project, parts, transcript, story)
    plan = Plan(project, parts, bus, clock, transcript, run_directory, how, setup, story, alerts, options.record)
    node = assemble(plan)
    transcript.unread = lambda: node.interrupt(2, leave=True)
    if project.console.wanted and BRAIN in parts:
        node.parts.append(ConsolePart(run_directory.root, url, partial(transcript.line, "console")))
    visitor = next((part for part in node.parts if isinstance(part, VisitorPart)), None)
    if visitor and story is None:
        greeting = "You are the visitor: type what you say, or /help. Ctrl-D walks away, Ctrl-C ends.\n"
        node.parts.append(TypedVisitorPart(visitor, transcript, greeting))
    place, what = url.rpartition("@")[2], ", ".join(parts)
    node.claimed = lambda: print(f"{project.name}: {what} of {project.robot}, on {place}, ready after {ready():.1f} s.")
    if setup:
        node.closing.append(_voice(options, setup, language or project.languages[0]))
        node.closing.append(_sounding(options, project, setup))
    _heed_signals(node)
    try:
        lived = node.run(period)
    finally:
        node.close()
    troubles = [] if story else node.troubles
    with_trouble = "Ended with trouble" if troubles else "Ended"
    print(f"\n{'The story failed' if node.failed else with_trouble}: {clock_time(lived)}.")
    summary = (*RunVerdict.listed(troubles), *node.summary())
    for line in summary:
        print(f"  {line}")
    if BRAIN in parts:
        run_directory.ended(node.project)
        run_directory.close(forget=not node.leaving)
    ended = INTERRUPTED if node.interrupted else FAILED if node.failed else TROUBLED if troubles else WELL
    return RunVerdict(ended, lived, failure=next(iter(troubles), ""), summary=summary)


@contextmanager
def _going_first() -> Iterator[None]:
    """Go before other programs where the system lets us: on a crowded machine a stop waits for none of them."""
    usual = None
    with suppress(AttributeError, OSError):
        usual = os.getpriority(os.PRIO_PROCESS, 0)
        os.setpriority(os.PRIO_PROCESS, 0, PRIORITY)
    try:
        yield
    finally:
        if usual is not None:
            with suppress(OSError):
                os.setpriority(os.PRIO_PROCESS, 0, usual)


def _heed_signals(node: Node) -> None:
    signal.signal(signal.SIGINT, lambda *_: node.interrupt())
    signal.signal(signal.SIGTERM, lambda *_: node.interrupt(2, leave=True))


def _check_processes(options: argparse.Namespace, story: Story | None, parts: Sequence[str], url: str) -> None:
    if url.startswith("memory:"):
        raise UsageError("several processes need a common bus: pass `--bus amqp://USER:PASSWORD@HOST/`")
    if options.speed == "max":
        raise UsageError(
            "several processes can run only in real time: leave out --speed max, or run everything in one process"
        )
    if options.video:
        raise UsageError("--video works only if everything runs in one process: leave out --only")
    if options.robot == "none" and ROBOT_PART in parts:
        raise UsageError("`--only robot` needs a robot: leave out --robot none")
    if story and story.robot and ROBOT_PART not in parts:
        raise UsageError(
            f"the story `{story.name}` has faults of the robot (`robot:`): pass --story to the robot's process, too"
        )


def _sounding(
    options: argparse.Namespace, project: Project, setup: Setup, track: AudioTrack | None = None
) -> Callable[[], None]:
    """Let the simulated robot's sound files be heard here, unless time flies, and in the film; what ends it."""
    if not isinstance(setup.robot, Sounds):
        return lambda: None
    loudspeaker = Loudspeaker(Path(project.root), track, audible=options.speed != "max")
    setup.robot.sound_with(loudspeaker)
    return loudspeaker.close


def _voice(
    options: argparse.Namespace, setup: Setup, language: str, track: AudioTrack | None = None
) -> Callable[[], None]:
    """Give the robot the voice that the flags ask for; what ends it. Raises UsageError or ModuleError."""
    if options.voice == "none" and not options.sound:
        return lambda: None
    from lumen.app.voice import voiced  # nobody else needs espeak-ng

    return voiced(setup, options.voice, options.sound, language, track)
