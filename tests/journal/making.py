"""Behaviours that run with a journal: random machines, events, other files, and starts after a crash."""

from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass, field, replace
from functools import cache
from pathlib import Path
from typing import Any

import lumen
from lumen.errors import LumenError
from lumen.insight.migration import MigrationPlan
from lumen.insight.replay.entries import RecordedEntry
from lumen.insight.replay.replaying import ReplayedStep, replay
from lumen.journal.journal_file import read_journal
from lumen.journal.journal_folder import JournalFolder
from lumen.journal.journal_writer import JournalWriter
from lumen.language.events import Event
from lumen.language.machines import MachineDefinition
from lumen.language.nanoseconds import to_the_nanosecond
from lumen.language.projects import Project
from lumen.run.resuming import Resumption, resume
from lumen.run.runtime import Runtime
from lumen.statechart import Step, deserialize, due, serialize
from tests import ROOT

MAX_TIMERS = 12
WRITTEN = 120.0
"""The time that a crowded machine may need to write the steps of a wild behaviour [s]."""


@cache
def minimal() -> Project:
    return lumen.load(ROOT / "examples/minimal")


def bundle(machine: MachineDefinition) -> Project:
    """Return a project in which this is the behaviour that runs."""
    return replace(minimal(), behaviors={machine.id: machine}, behavior=machine.id, hash=machine.hash)


@dataclass
class Recorded:
    """A run that is recorded into `folder`; `again` returns the replay of its journal."""

    folder: Path
    steps: list[Step] = field(default_factory=list)
    bundles: dict[str, Project] = field(default_factory=dict)

    def begin(self, machine: MachineDefinition) -> None:
        self.now = 1.0
        self._run(bundle(machine))
        self.runtime.start(self.now, epoch=1_700_000_000.0, timezone="Europe/Berlin")

    def happen(self, happening: tuple[str, Any] | None, number: int) -> None:
        """Handle an outside event; or in turn let time pass, answer an awaited command, or refuse it.

        Do nothing if timers have already set too many timers.
        """
        if len(self.runtime.snapshot.timers) > MAX_TIMERS:
            return
        if happening is None and number % 3 == 0 and (event := due(self.runtime.snapshot)):
            self.now = max(self.now, to_the_nanosecond(event.at + 0.001))
            self.runtime.tick(self.now)
            return
        self.now = to_the_nanosecond(self.now + 0.05)
        kind = "done" if number % 3 == 1 else "error"
        name, data = happening or (f"{kind}.command.d{self.runtime.snapshot.counters.awaited}", None)
        self.runtime.tick(self.now, [Event(name, data, to_the_nanosecond(self.now - 0.02 * (number % 2)))])

    def reload(self, machine: MachineDefinition) -> None:
        """Continue under another machine, if that is possible."""
        project = bundle(machine)
        self.bundles[project.hash] = project
        with suppress(LumenError):
            plan = self.runtime.plan(project, self.now, now=True)
            if isinstance(plan, MigrationPlan):
                self.runtime.apply(project, plan.snapshot, "reload", plan.commands)

    def crash(self) -> None:
        """End without notice, then resume from the state at the last write."""
        project, frozen = self.runtime.project, serialize(self.runtime.project.machine, self.runtime.snapshot)
        self.end()  # of its thread only: the journal is as a crash leaves it
        self._run(project)
        found = resume(project, project, deserialize(project.machine, frozen), 3.0, (), 0.5)
        assert isinstance(found, Resumption)
        self.now = 0.0
        self.runtime.apply(project, found.snapshot, "resume", found.commands)

    def end(self) -> None:
        assert self.writer.flush(WRITTEN)
        self.writer.close()

    def entries(self) -> list[RecordedEntry]:
        files = JournalFolder(self.folder, 30.0, 100.0).files()
        return [entry for file in files for entry in read_journal(file).entries]

    def again(self, entries: Iterable[RecordedEntry] | None = None) -> list[ReplayedStep]:
        return list(replay(self.entries() if entries is None else entries, self.machine))

    def machine(self, hash: str, behavior: str) -> MachineDefinition:
        return self.bundles[hash].behaviors[behavior]

    def _run(self, project: Project) -> None:
        self.bundles[project.hash] = project
        self.writer = JournalWriter(JournalFolder(self.folder, 30.0, 100.0), rehearsed=True)
        self.writer.start()
        self.runtime = Runtime(project, self.steps.append)
        self.runtime.recorder = self.writer
