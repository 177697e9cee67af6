"""What is told of a reload: as JSON on the bus and in the journal, and as lines for people."""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from typing import Any

from lumen.insight.changes import Change, Risk, change_data, risk, summary
from lumen.insight.migration import MigrationDelay, Refusal
from lumen.language.diagnostics import Diagnostic, Severity
from lumen.language.projects import Project
from lumen.run.reload.validator import Validation, told

MAX_LISTED = 100
"""Changes and diagnostics that a bulletin lists."""
OPEN = ("waiting", "judging")
"""Verdicts after which another one follows."""
START = "start"


@dataclass
class ReloadReport:
    """One verdict on files: `unchanged`, `staged`, `waiting`, `applied`, `refused`, `rolled back`, `dry run`, `status`.

    `who` asked for it: `files`, `command`, `trial`, `probation`, or the `start` of a run on other files than those
    before. `before` and `after` are hashes of bundles, `restart` sentences about what becomes active only then, `took`
    times [s] by what took them. `back`: the files ran before. `told_visits`: what came of recorded visits was told
    already. `details` has the data of each listed change (`change_data`).
    """

    verdict: str
    who: str
    before: str = ""
    after: str = ""
    revision: int = 0
    changes: tuple[Change, ...] = ()
    validation: Validation | None = None
    waiting_for: str = ""
    reason: str = ""
    hint: str = ""
    notes: tuple[str, ...] = ()
    back: bool = False
    took: dict[str, float] = field(default_factory=dict)
    more: dict[str, Any] = field(default_factory=dict)
    told_visits: bool = False
    details: list[dict[str, Any]] = field(default_factory=list)

    def compared(self, project: Project) -> "ReloadReport":
        """Return the same with the details of its changes, which led to `project`."""
        return replace(self, details=[change_data(change, project) for change in self.changes[:MAX_LISTED]])

    def kept(self) -> "ReloadReport":
        """The same without the files and the project that it is about."""
        validation = self.validation and self.validation.kept()
        return replace(self, validation=validation)

    @property
    def diagnostics(self) -> tuple[Diagnostic, ...]:
        """Everything wrong with the files; where one is an error, they were refused."""
        return self.validation.diagnostics if self.validation else ()

    @property
    def restart(self) -> list[str]:
        """What becomes active only when the exhibition is started anew."""
        return [str(change) for change in self.changes if change.risk is Risk.RESTART and self.who != START]

    def lines(self) -> Iterator[str]:
        """What a person is told, the reasons before the verdict."""
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
        """The body on `lumen.config.status`, and the entry in the journal."""
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
    """Why it can't be, with the place in the new files where it could be said."""
    place = project.place(f"behaviors/{refusal.behavior}.yaml", refusal.where) if refusal.behavior else None
    return f"{place}: {refusal.reason}" if place else refusal.reason


def what_for(verdict: MigrationDelay | Refusal) -> str:
    """The state that has to be left first."""
    return verdict.what if isinstance(verdict, MigrationDelay) else verdict.state
