"""The internals of the engine that goldens use: if they move, only this module changes."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple
from unittest.mock import patch

import lumen
from lumen.bus.local import LocalBusServer
from lumen.bus.local.address import LocalAddress
from lumen.bus.local.client import LocalBusClient
from lumen.bus.memory import matches
from lumen.cli.main import main
from lumen.insight.replay.entries import entry_data
from lumen.insight.replay.forking import fork
from lumen.insight.replay.replaying import replay
from lumen.journal.journal_file import FramePacker, line_of, read_journal, read_lines, unpack
from lumen.language.body_parts import WHOLE_BODY
from lumen.language.command_data import command_data
from lumen.language.commands import Say
from lumen.language.gestures import merged
from lumen.ports import Live, Perform, Sense
from lumen.project.home import Home
from lumen.robot.life_layer import LifeLayer
from lumen.robot.recording import RecordingRobot
from lumen.run.recovery.previous_run import recover
from lumen.run.rehearsal import rehearse
from lumen.run.reload.records import RunRecords
from lumen.run.replaying.journals import KeptBundles
from lumen.run.replaying.other_files import takes
from lumen.run.resuming import FreshStart, Resumption, resume
from lumen.statechart import deserialize, serialize
from tests.golden.texts import in_one_line

__all__ = [
    "KeptBundles",
    "LocalAddress",
    "LocalBusClient",
    "LocalBusServer",
    "Replayed",
    "Sense",
    "alive",
    "continued",
    "forked",
    "journal_lines",
    "main",
    "matches",
    "read_positions",
    "recovered",
    "reloaded_to",
    "replayed",
    "robot_commands",
    "told_to_robots",
]


def command_text(command: Any) -> Any:
    """Return a command as JSON data, as in the journal; a motion and a style only by name."""
    match command:
        case Perform(motion):
            return {"Perform": motion.name}
        case Live(style, gestures):
            return {"Live": {"style": style.name, "gestures": len(gestures.gestures)}}
    return command_data(command)


@contextmanager
def told_to_robots(tell: Callable[[float, str, str, Any], None]) -> Iterator[None]:
    """Call `tell` with the time, the verb, the id and the command of each call of a recording robot."""
    start, cancel = RecordingRobot.start, RecordingRobot.cancel

    def started(robot: RecordingRobot, id: str, command: Any) -> None:
        tell(robot.time, "start", id, command_text(command))
        start(robot, id, command)

    def cancelled(robot: RecordingRobot, id: str) -> None:
        tell(robot.time, "cancel", id, None)
        cancel(robot, id)

    with patch.object(RecordingRobot, "start", started), patch.object(RecordingRobot, "cancel", cancelled):
        yield


def robot_commands(project: lumen.Project, story: str) -> list[tuple[float, str, str, Any]]:
    """Return the commands to the robot in a rehearsed story; the last entry is the end, with the failure if there was
    one.
    """
    told: list[tuple[float, str, str, Any]] = []
    with told_to_robots(lambda *command: told.append(command)):
        played = rehearse(project, project.stories[story])
    return [*told, (played.time, "end", "", str(played.failed) if played.failed else None)]


def alive(project: lumen.Project, style: str, seconds: float) -> Iterator[dict[str, float]]:
    """Yield the offset of each joint by life [rad] at 50 Hz, while the robot hears, speaks and is led as in a visit."""
    layer, body = LifeLayer(project.body, seed=7), project.body
    layer.live(Live(project.life[style], merged(project.gestures)))
    free = frozenset(WHOLE_BODY)
    for tick in range(round(seconds * 50)):
        now = tick / 50
        match tick:
            case 250:
                layer.heard(0.6, -0.1, now)
            case 500:
                layer.say(Say("Hello! I am pleased to meet you, and this is a large hall."), 4.0, now)
            case 900:
                layer.led(body.joints, now)
            case 1200:
                layer.touched("FrontTactil", now)
        busy = frozenset({"head"}) if 1300 <= tick < 1400 else frozenset()
        yield dict(layer.advance(now, 1 / 50, free - busy, lambda _part: 1.0))


class Replayed(NamedTuple):
    """An entry of a journal, taken again: the entry as JSON data, what came of it, and the snapshot after it.

    `differs` has the outcome of then and that of now if they differ; `unknown` is the reason if no step was possible.
    """

    position: int
    entry: dict[str, Any]
    exited: tuple[str, ...]
    entered: tuple[str, ...]
    commands: tuple[Any, ...]
    digest: str
    snapshot: dict[str, Any] | None
    differs: tuple[str, str] | None
    unknown: str


def journal_lines(file: Path) -> tuple[bytes, bool, list[bytes], list[bytes], bool]:
    """Return the header of a journal written again, whether it is whole, its lines, the same lines written again.

    The last is whether these are read as they are written after they were packed into frames.
    """
    content, lines = read_journal(file), read_lines(file)
    again = [line_of(entry) for entry in content.entries]
    packer = FramePacker()
    packed = b"".join(packer.pack(line) for line in again)
    return content.header.line(), content.whole, lines, again, [text for text, _ in unpack(packed)] == again


def replayed(file: Path, bundles: KeptBundles) -> Iterator[Replayed]:
    """Yield the entries of a journal, each taken again with the files that ran then."""
    for row in replay(read_journal(file).entries, bundles.machine):
        now = row.now
        after = serialize(row.machine, row.after) if row.machine and row.after else None
        yield Replayed(
            row.entry.position,
            entry_data(row.entry),
            now.exited if now else (),
            now.entered if now else (),
            now.commands if now else (),
            now.digest if now else "",
            after,
            (str(row.was), str(now)) if row.differs else None,
            row.unknown,
        )


def read_positions(file: Path, event: str) -> list[int]:
    """Return the positions in a journal at which that event came from outside."""
    entries = read_journal(file).entries
    return [entry.position for entry in entries if entry_data(entry).get("heard") == event]


def reloaded_to(file: Path, bundles: KeptBundles) -> lumen.Project:
    """Return the project that ran when a file of a journal was written."""
    project = bundles.load(read_journal(file).header.bundle)
    assert project
    return project


def forked(
    file: Path, position: int, bundles: KeptBundles, event: lumen.Event | None, saved: lumen.Project | None
) -> tuple[list[dict[str, Any]], list[dict[str, Any]], str]:
    """Return a journal's entries from a position on, those of the fork, and the trouble that ended the fork."""
    found = fork(read_journal(file).entries, position, bundles.project, takes, event=event, saved=saved)
    return list(found.was), list(found.would), found.trouble


def continued(
    old: lumen.Project, new: lumen.Project, frozen: dict[str, Any], away: float, unchanged: float
) -> list[str]:
    """Return how a start continues from a snapshot, `away` [s] after the end: sentences, or the reason against it."""
    found = resume(old, new, deserialize(old.machine, frozen), away, ("head", "gone"), unchanged)
    return _how(found, new)


def recovered(root: Path, project: lumen.Project, now: float) -> list[str]:
    """Return how a start at `now` [s since 1970] continues from the home of a run that ended before."""
    home = Home(root / ".lumen")
    assert home.hold()
    records = RunRecords(home)
    try:
        with patch("time.time", lambda: now):
            found = recover(root, records, project)
    finally:
        records.close()
        home.release()
    return [*_how(found.how, project), *(f"  news {one.verdict}: {', '.join(one.notes)}" for one in found.news)]


def _how(found: Any, project: lumen.Project) -> list[str]:
    match found:
        case FreshStart(why, rests, crashed):
            return [f"  begins anew: {why or 'without a word'}; rests: {rests}, crashed: {crashed}"]
        case Resumption():
            return [
                f"  continues after {found.away:.3f} s, told to end: {found.told}",
                *_standing(serialize(project.machine, found.snapshot)),
                *(f"  command {in_one_line(command_text(command))}" for command in found.commands),
                f"  lost {' '.join(found.lost)}",
                f"  tracking {' '.join(found.tracking)}",
                *(f"  note {note}" for note in found.notes),
            ]
    return [f"  can't go on: {found.reason}"]


def _standing(now: dict[str, Any]) -> list[str]:
    """Return states, context, timers and pending work of a snapshot."""
    lines = [f"  states {' '.join(now['configuration'])}", f"  context {in_one_line(now['context'])}"]
    lines += [f"  timer {one['event']} in {one['due'] - now['at']:.6f} of {one['delay']:g} s" for one in now["timers"]]
    return [*lines, *(f"  {what} {in_one_line(now[what])}" for what in ("doing", "halted", "history") if now[what])]
