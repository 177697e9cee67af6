"""A journal shown again: narrated and performed by a robot, at the original pace or faster."""

from collections.abc import Iterable

from lumen.bus.memory import MemoryBus
from lumen.insight.replay.entries import JournalInput, JournalJump, RecordedEntry
from lumen.insight.replay.replaying import Replayer
from lumen.language.projects import Project
from lumen.run.narrator import Narrator
from lumen.run.performer import Performer
from lumen.run.replaying.journals import KeptBundles
from lumen.run.setup import Setup

LEAD_IN = 1.0
"""The time before the first entry of a run [s]."""


def show(entries: Iterable[RecordedEntry], bundles: KeptBundles, setup: Setup, narrator: Narrator) -> None:
    """Take all steps again, narrate them, and let the robot perform their commands.

    The robot's answers are ignored. Pauses between runs are skipped.
    """
    replayer = Replayer(bundles.machine)
    performer = Performer(setup.robot, MemoryBus(), lambda _: None)
    project: Project | None = None
    shift: float | None = None
    for entry in entries:
        row, at = replayer.take(entry), entry.at if isinstance(entry, JournalJump) else entry.event.at
        if isinstance(entry, JournalJump):
            project = bundles.project(entry.bundle, entry.behavior)
            if entry.kind in ("start", "resume", "gap"):
                shift = None
        if shift is None:
            shift = setup.clock.now() + LEAD_IN - at
        if at + shift > setup.clock.now():
            setup.clock.wait(at + shift)
        setup.robot.poll()
        if row.step is None or project is None:
            continue
        if isinstance(entry, JournalInput):
            _tell(entry, narrator)
        narrator.stepped(row.step)
        for command in row.step.commands:
            narrator.performing(command, setup.clock.now())
            performer.perform(project, command, setup.clock.now())


def _tell(entry: JournalInput, narrator: Narrator) -> None:
    """Narrate a visitor's words; other inputs are narrated by their effects."""
    data = entry.event.data
    if isinstance(data, dict) and isinstance(said := data.get("result"), str):
        narrator.line("visitor", f"“{said}”")
