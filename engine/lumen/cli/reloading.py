"""Saved files on a running exhibition: taken where they are good, reported where they are not."""

import time
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from lumen.cli.show import Show
from lumen.cli.transcript import Transcript
from lumen.language.diagnostics import Diagnostic, Severity
from lumen.language.projects import Project
from lumen.runtime.watcher import Watcher

PATIENCE = 60.0

FIXED = ("robot", "body", "hall", "stage", "bus")
"""What of a project can't change while it runs."""


class Reloading:
    """Stages every good bundle and applies it at the first tick at which the running state allows it."""

    def __init__(self, show: Show, transcript: Transcript) -> None:
        self._show, self._transcript = show, transcript
        self._watcher = Watcher(Path(show.exhibition.project.root), show.exhibition.project.hash)
        self._staged: Project | None = None
        self._since = 0.0
        self._waiting = ""
        self._watcher.start()

    def close(self) -> None:
        self._watcher.close()

    def tick(self, now: float) -> None:
        """See what the watcher found, and apply what is staged."""
        while not self._watcher.results.empty():
            project, diagnostics = self._watcher.results.get()
            self._report(diagnostics)
            if project is None:
                self._staged = None
                self._transcript.line("reload", "refused: the exhibition goes on as it was")
            else:
                self._staged, self._since, self._waiting = project, time.monotonic(), ""
        if self._staged:
            self._apply(self._staged)

    def _apply(self, project: Project) -> None:
        running = self._show.exhibition.project
        fixed = {name: getattr(running, name) for name in FIXED}
        waiting = [name for name, value in fixed.items() if getattr(project, name) != value]
        reason = self._show.reload(replace(project, **fixed))
        if not reason:
            self._transcript.line("reload", "the saved files are in force")
            if waiting:
                self._transcript.line("reload", f"what changed in {', '.join(waiting)} needs a restart")
        elif time.monotonic() - self._since < PATIENCE:
            if reason != self._waiting:
                self._transcript.line("reload", f"waiting: {reason}")
                self._waiting = reason
            return
        else:
            self._transcript.line("reload", f"refused: {reason}")
        self._staged = None

    def _report(self, diagnostics: Sequence[Diagnostic]) -> None:
        for diagnostic in diagnostics:
            if diagnostic.severity is Severity.ERROR:
                self._transcript.line("reload", str(diagnostic))
