"""`lumen run`: run an exhibition, in one process or in several."""

import argparse
import os
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager, nullcontext, suppress
from pathlib import Path

from lumen.bus.addresses import examples, within_process
from lumen.cli.extras import of_extras
from lumen.cli.formats import configure_format, one_object
from lumen.cli.main import ready
from lumen.cli.model_option import configure_model, use_model
from lumen.cli.performance import GREETING, Performance
from lumen.cli.printing import clock_time
from lumen.cli.run_choices import chosen_story, language_of, period_of, robot_of, wishes
from lumen.cli.run_plan import RobotRun, bus_hint, compose_or_hint, heed_signals, leave, plan_of, running
from lumen.cli.run_verdict import RunVerdict, end_of, troubles_of
from lumen.cli.streams import complain
from lumen.cli.transcript import Transcript
from lumen.clock.following import FollowingClock
from lumen.errors import ProjectError, UsageError
from lumen.feature import table
from lumen.journal.journal_folder import JOURNAL_FOLDER
from lumen.language.projects import Project
from lumen.ports import Clock
from lumen.project.broken_features import broken_features
from lumen.project.home import home_of as home_of_run
from lumen.project.main_file import main_settings
from lumen.project.running_project import is_substituted, project_to_run
from lumen.run.audio_track import AudioTrack
from lumen.run.chosen_stories import project_of
from lumen.run.compose import begin, claim
from lumen.run.loudspeaker import sounding
from lumen.run.one_robot import robots_of
from lumen.run.plan import Plan
from lumen.run.presence import BRAIN, ROBOT_PART, all_parts
from lumen.run.processes.choosing import parts_of
from lumen.run.recovery.run_directory import RunDirectory
from lumen.run.reload.reloader import MODES
from lumen.run.run_start import BegunRun, started
from lumen.run.services import Services
from lumen.run.setup import SPEEDS, Setup, robot_kind, robot_names, robot_options
from lumen.standalone.project import load
from lumen.upkeep.heap import give_back

PROCESS_GREETING = "You are the visitor: type what you say, or /help. Ctrl-D walks away, Ctrl-C ends.\n"
PRIORITY = -10
"""The niceness of an exhibition in real time; it needs root or a permission, such as systemd's `LimitNICE=-10`."""


def configure(parser: argparse.ArgumentParser) -> None:
    """Add the options of `lumen run` to its parser."""
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
        choices=_OfferedRobots(robot_names()),
        default="",
        help="the robot that performs the exhibition, or one of your own in drivers/ (default: simulation)",
    )
    add(
        "--only",
        metavar="PARTS",
        help=f"run only these parts, separated by commas: {', '.join(all_parts())}, or a module of your own",
    )
    for option in robot_options():
        add(option.flag, metavar=option.metavar, help=option.help)
    add("--speed", choices=SPEEDS, default="1", help="speed of simulated time, as a multiple of real time (default: 1)")
    add("--bus", metavar="URL", help=f"{examples()} (default: LUMEN_BUS, then lumen.yaml)")
    add("--for", dest="period", metavar="60s", help="end after this much simulated time")
    add("--language", metavar="LANG", help="the language that the robot speaks first")
    of_extras("run_options", lambda extra: extra.configure(parser), installed=False)
    add("--record", metavar="FILE.mcap", type=Path, help="record the messages on the bus, for Foxglove and Lichtblick")
    add(
        "--voice",
        choices=("none", *table("voices")),
        default="none",
        help="speak the simulated robot's texts with espeak-ng (default: none)",
    )
    add("--sound", metavar="FILE.wav", type=Path, help="with --voice: write the speech to a file instead of playing it")
    _configure_files(parser)
    configure_format(parser)
    of_extras("run_options", lambda extra: extra.configure(parser), installed=True)


def _configure_files(parser: argparse.ArgumentParser) -> None:
    """Add the options about saved files, and about continuing the previous run."""
    add = parser.add_argument
    add(
        "--reload",
        choices=MODES,
        default="auto",
        help="use saved files at once, at `lumen reload`, or never (default: auto)",
    )
    add("--last-good", action="store_true", help="if the files have errors, start with the last ones that had none")
    add("--fresh", action="store_true", help="start from the beginning, even if the last run ended unexpectedly")


class _OfferedRobots(tuple[str, ...]):
    """The robots that `--help` lists. Any name is accepted: a project's own drivers are known only once it is read."""

    __slots__ = ()

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str)


def run(options: argparse.Namespace) -> int:
    """Run the robots that the options choose, and print the verdict; return its exit code.

    Raises UsageError for options that contradict each other, and other LumenErrors if the run can't start.
    """
    give_back()
    named = () if options.story is None else (options.story,)
    path = options.project or project_of(named)
    root = project_to_run(path)
    use_model(options.model, [root])
    for broken in broken_features():
        complain(str(broken))
    if is_substituted(path):
        journal = home_of_run(root) / JOURNAL_FOLDER
        complain(
            f"There is no lumen.yaml here or above: Lumen runs a copy of its own exhibition, {root}. Its journal is"
            f" {journal}. `lumen new DIR` makes a project of your own."
        )
    options.robot = robot_kind(options.robot, root)
    parts, robots = _parts(options, root), robots_of(root, options.robot_name)
    of_extras("run_options", lambda extra: extra.check(options, parts, len(robots)))
    if len(robots) > 1:
        from lumen.cli.house_run import check_house  # only a run of several robots needs it

        check_house(options, parts)
    with (
        one_object(options.format) as say,
        nullcontext() if options.speed == "max" else _going_first(),
        started(root, robots, parts, last_good=options.last_good, alerted=not options.story, tell=complain) as start,
    ):
        verdict = _house(options, start, parts) if len(robots) > 1 else _run(options, start, parts)
        say(verdict.to_json(str(root.absolute()), options.story))
        return verdict.code


def _parts(options: argparse.Namespace, root: Path) -> tuple[str, ...]:
    """Return the parts that this process runs.

    Raises UsageError for an invalid choice, ProjectError if the project has errors.
    """
    settings = main_settings(root) if options.only is not None else None
    try:
        return parts_of(options.only, options.robot, settings.modules if settings else {})
    except UsageError:
        try:
            load(root)  # a part may be unknown only because lumen.yaml, which names it, has errors: these come first
        except ProjectError:
            if (good := _last_good(options, root)) is None:
                raise
            return parts_of(options.only, options.robot, good.modules)
        raise


def _last_good(options: argparse.Namespace, root: Path) -> Project | None:
    """Return the last good bundle if the options allow a start with it; None if none was kept."""
    if not options.last_good:
        return None
    robot = next(iter(robots_of(root, options.robot_name)), "")
    return RunDirectory(root, robot, guest=True).last_good()


def _house(options: argparse.Namespace, start: BegunRun, parts: tuple[str, ...]) -> RunVerdict:
    """Run several robots in this process, and return how the run went."""
    from lumen.cli.house_run import HouseRun  # only a run of several robots needs it

    return HouseRun(options, start, parts).run()


def _run(options: argparse.Namespace, start: BegunRun, parts: tuple[str, ...]) -> RunVerdict:
    """Run one robot, or these parts of its exhibition."""
    (project,), (directory,) = start.projects.values(), start.directories.values()
    story = chosen_story(project, options, parts)
    period = period_of(options.period)
    one, url = RobotRun(project, directory, story), options.bus or os.environ.get("LUMEN_BUS") or project.bus
    if parts:
        return _processes(options, one, parts, url, period)
    return _whole(options, one, url, period)


def _whole(options: argparse.Namespace, one: RobotRun, url: str, period: float | None) -> RunVerdict:
    """Run a whole exhibition in this process."""
    project, story, made = one.project, one.story, list[Services]()
    more = {**wishes(options, project, story, period), "record": options.record, "greeting": GREETING}
    setup = robot_of(options, project, story)
    performance = Performance(setup, project, made)
    with _heard(options, one, setup, more.get("track")):
        plan = plan_of(options, one, (), url, setup, setup.clock, performance.transcript, **more)
        with _composed(plan, made) as services:
            performance.introduce(services, options.speed)
            begin([services])
            performance.run(services, period)
        _ended(one, services)
        return performance.summary(services, more.get("video"))


def _processes(
    options: argparse.Namespace, one: RobotRun, parts: tuple[str, ...], url: str, period: float | None
) -> RunVerdict:
    """Run these parts of an exhibition. Raises UsageError for options that several processes can't have."""
    project, story, made = one.project, one.story, list[Services]()
    _check_processes(options, parts, url)
    setup = robot_of(options, project, story) if ROBOT_PART in parts else None
    clock: Clock = setup.clock if setup else FollowingClock(float(options.speed))
    transcript = Transcript(clock.now, lambda: running(made, project).machine, unread=lambda: leave(made))
    more = {**wishes(options, project, story, period), "record": options.record, "greeting": PROCESS_GREETING}
    plan = plan_of(options, one, parts, url, setup, clock, transcript, **more)
    with _heard(options, one, setup), _composed(plan, made, bus_hint(options)) as services:
        place, what = url.rpartition("@")[2], ", ".join(parts)
        print(f"{project.name}: {what} of {project.robot}, on {place}, ready after {ready():.1f} s.")
        begin([services])
        lived = services.node.run(period)
    if BRAIN in parts:
        _ended(one, services)
    return _summed_up(services, lived)


def _summed_up(services: Services, lived: float) -> RunVerdict:
    """Print how the run of these parts went, and return its verdict."""
    node = services.node
    of_parts, troubles = node.summary(), troubles_of(node, judged=services.plan.story is not None)
    end = end_of([services], troubles)
    print(f"\n{end.words}: {clock_time(lived)}.")
    summary = (*RunVerdict.listed(troubles), *of_parts)
    for line in summary:
        print(f"  {line}")
    return RunVerdict(end.ended, lived, failure=end.failure, summary=summary)


@contextmanager
def _composed(plan: Plan, made: list[Services], hint: str = "") -> Iterator[Services]:
    """Compose an exhibition, put it into `made`, claim its roles and handle signals; close it when the block ends."""
    services = compose_or_hint(plan, hint)
    made.append(services)
    heed_signals(made)
    try:
        claim(made)
        yield services
    finally:
        services.node.close()


def _ended(one: RobotRun, services: Services) -> None:
    """Record in the run's directory that the run ended normally."""
    one.directory.ended(services.project)
    one.directory.close(forget=not services.node.leaving)


@contextmanager
def _going_first() -> Iterator[None]:
    """Raise this process's priority if the system allows it, so that a stop is not delayed on a busy machine."""
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


def _check_processes(options: argparse.Namespace, parts: Sequence[str], url: str) -> None:
    if within_process(url):
        raise UsageError("several processes need a common bus: pass `--bus amqp://USER:PASSWORD@HOST/`")
    if options.speed == "max":
        raise UsageError(
            "several processes can run only in real time: leave out --speed max, or run everything in one process"
        )
    if options.robot == "none" and ROBOT_PART in parts:
        raise UsageError("`--only robot` needs a robot: leave out --robot none")


@contextmanager
def _heard(
    options: argparse.Namespace, one: RobotRun, setup: Setup | None, track: AudioTrack | None = None
) -> Iterator[None]:
    """Connect a simulated robot to a voice, if the options choose one, and to a loudspeaker, until the block ends.

    Their sound also goes to `track`, the sound of a film. Raises UsageError or ModuleError if the voice can't be used.
    """
    with ExitStack() as stack:
        if setup and (options.voice != "none" or options.sound):
            from lumen.run.voices import voiced  # few runs need a voice

            language = language_of(one.project, options.language) or one.project.languages[0]
            stack.callback(voiced(setup, options.voice, options.sound, language, track))
        if setup:
            root, audible = Path(one.project.root), options.speed != "max"
            stack.enter_context(sounding([setup.robot], root, track, audible=audible))
        yield
