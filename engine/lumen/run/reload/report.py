"""The report on a reload: JSON for the bus and the journal, and lines for people."""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import Any

from lumen.insight.changes import Change, Risk, change_data, risk, summary
from lumen.insight.migration import MigrationDelay, Refusal
from lumen.language.diagnostics import Diagnostic, Severity
from lumen.language.projects import Project
from lumen.run.reload.validator import Validation, told

MAX_LISTED = 100
"""The greatest number of changes and of diagnostics that a report lists."""
OPEN = ("waiting", "judging")
"""Verdicts that are followed by another one."""
START = "start"
"""The value of `who` for a reload at the start of a run."""


@dataclass
class ReloadReport:
    """One verdict on files."""

    verdict: str
    """The result of a reload: `unchanged`, `staged`, `waiting`, `applied`, `refused`, `rolled back` or `dry run`.

    In an answer to a request also `judging`, `stopped` or `status`.
    """
    who: str
    """The origin: `files`, `command`, `trial`, `probation`, or `start` for a run with other files than the last."""
    before: str = ""
    """The hash of the bundle before the reload."""
    after: str = ""
    """The hash of the bundle that was judged."""
    revision: int = 0
    """The number of bundles that became active in this run."""
    changes: tuple[Change, ...] = ()
    """The changes from `before` to `after`."""
    validation: Validation | None = None
    """The result of checking the files; None if they were not checked."""
    waiting_for: str = ""
    """The state that must be left first; empty unless the verdict is `waiting`."""
    reason: str = ""
    """The reason for the verdict; empty if the verdict needs none."""
    hint: str = ""
    """Advice for people; empty if there is nothing to do."""
    notes: tuple[str, ...] = ()
    """Further sentences for people."""
    back: bool = False
    """Whether the files ran before."""
    took: dict[str, float] = field(default_factory=dict)
    """Durations [s], by activity."""
    more: dict[str, Any] = field(default_factory=dict)
    """Further fields of the JSON data."""
    told_visits: bool = False
    """Whether the result for recorded visits was reported before."""
    details: list[dict[str, Any]] = field(default_factory=list)
    """The data of each listed change (`change_data`)."""

    def compared(self, project: Project) -> "ReloadReport":
        """Return a copy with the details of the first changes; `project` is the bundle to which they led."""
        return replace(self, details=[change_data(change, project) for change in self.changes[:MAX_LISTED]])

    def kept(self) -> "ReloadReport":
        """Return a copy whose validation has neither the files nor the projects, which use much memory."""
        validation = self.validation and self.validation.kept()
        return replace(self, validation=validation)

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """All findings in the files; an error among them means that the files were refused."""
        return self.validation.diagnostics if self.validation else ()

    @property
    def restart(self) -> list[str]:
        """The changes that become active only at the next start."""
        return [str(change) for change in self.changes if change.risk is Risk.RESTART and self.who != START]

    def lines(self) -> Iterator[str]:
        """Yield the lines for people, the reasons before the verdict."""
        if self.validation:
            errors = (d for d in self.validation.diagnostics if d.severity is Severity.ERROR)
            yield from map(str, list(errors)[:MAX_LISTED])
            yield from (f"{told(rehearsal)}" for rehearsal in self.validation.failed)
            if self.validation.visits and not self.told_visits:
                yield from self.validation.visits.lines()
        yield from (said := list(self._verdict()))
        yield from self.notes
        if self.verdict in ("applied", "dry run"):
            yield from (later for later in self.restart if later not in said[0])

    def _verdict(self) -> Iterator[str]:
        match self.verdict:
            case "applied":
                yield f"{self._taken()}{', ' + self.reason if self.reason else ''}: {self._what()}"
            case "rolled back":
                yield f"{self.reason}: back to the previous files, revision {self.revision}"
            case "refused":
                goes_on = (
                    "the last good files are active" if self.who == START else "the exhibition continues unchanged"
                )
                yield f"refused: {self._why()}{goes_on}"
            case "waiting":
                yield f"waiting for `{self.waiting_for}`: {self.reason} (`lumen reload --now` does not wait)"
            case "staged":
                yield f"staged: {self._what()}; `lumen reload --apply` activates it"
            case "unchanged":
                yield self.reason or "the saved files are already active"
            case "dry run":
                yield f"{self._what()}; {self.reason}"
            case _:
                yield self.reason

    def _taken(self) -> str:
        if self.back:
            return "the previous files are active again"
        all_later = 0 < len(self.changes) == len(self.restart)
        return "the saved files are good" if all_later else "the saved files are active"

    def _what(self) -> str:
        return f"{summary(self.changes)} (risk: {risk(self.changes)})"

    def _why(self) -> str:
        if self.validation and self.validation.failed:
            names = ", ".join(f"`{rehearsal.story.name}`" for rehearsal in self.validation.failed)
            return f"stories that fail with these files: {names}; "
        hint = f" ({self.hint})" if self.hint else ""
        return f"{self.reason}{hint}; " if self.reason else ""

    def _took(self) -> dict[str, float]:
        if self.validation is None:
            return self.took
        validation = {"loading": self.validation.loading, "stories": self.validation.playing}
        if self.validation.visits:
            validation["visits"] = self.validation.replaying
        return {**validation, **self.took}

    def to_json(self) -> dict[str, Any]:
        """Return the body that is sent on `lumen.config.status`, which is also the entry in the journal."""
        found: dict[str, Any] = {
            "verdict": self.verdict,
            "final": self.verdict not in OPEN,
            "who": self.who,
            "before": self.before,
            "after": self.after,
            "revision": self.revision,
        }
        if self.changes or self.verdict in ("applied", "staged", "dry run"):
            found["risk"] = str(risk(self.changes))
            found["changes"] = [str(change) for change in self.changes[:MAX_LISTED]]
            found["restart"] = self.restart
            if any(detail["line"] for detail in self.details):
                found["details"] = self.details
        if self.validation:
            found["diagnostics"] = [d.to_json() for d in self.validation.diagnostics[:MAX_LISTED]]
            found["stories"] = [told(rehearsal) for rehearsal in self.validation.failed]
            if self.validation.visits:
                found["visits"] = self.validation.visits.to_json()
        if took := self._took():
            found["took"] = took
        named = {"waiting_for": self.waiting_for, "reason": self.reason, "hint": self.hint, "notes": list(self.notes)}
        return {**found, **{name: value for name, value in named.items() if value}, **self.more}


def reason_of(refusal: Refusal, project: Project) -> str:
    """Return why a reload is refused, after the place in the new files if there is one."""
    place = project.place(f"behaviors/{refusal.behavior}.yaml", refusal.where) if refusal.behavior else None
    return f"{place}: {refusal.reason}" if place else refusal.reason


def what_for(verdict: MigrationDelay | Refusal) -> str:
    """Return the state that must be left first; empty if no state would help."""
    return verdict.what if isinstance(verdict, MigrationDelay) else verdict.state
