"""Decisions of people while an exhibition runs: approvals, the language model, and the check of their requests."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Protocol

from lumen.bus.checking import SchemaCheck
from lumen.language.approvals import Autonomy
from lumen.language.modules import ANSWERS
from lumen.language.operator_requests import REQUESTS, UNLISTED, OperatorRequest
from lumen.language.projects import Project
from lumen.project.home import Home
from lumen.run.approvals import Approvals, HeldEvent
from lumen.run.narrator import Narrator
from lumen.run.questions import Questions
from lumen.run.raised_events import refusal


class RequestChecks:
    """A checker of bodies by the schemas of all requests; each schema is compiled when it is first needed."""

    def __init__(self) -> None:
        self._rows = {row.ask: (row, SchemaCheck(row.schema)) for row in REQUESTS}

    def valid(self, body: Any) -> OperatorRequest | None:
        """Return the kind of request in a body; None if it is not a request, or a field is missing or wrong."""
        row, check = self._found(body)
        return row if check and check.fits(body) else None

    def fault(self, body: Any) -> str:
        """Return why a body that is not `valid` is refused."""
        row, _ = self._found(body)
        if row and row.fault:
            return row.fault
        *shown, last = [each.shown for each in REQUESTS if each not in UNLISTED]
        return f"the request is not valid: send {', '.join(shown)}, or {last}"

    def _found(self, body: Any) -> tuple[OperatorRequest | None, SchemaCheck | None]:
        ask = body.get("ask") if isinstance(body, dict) else None
        return self._rows.get(ask, (None, None)) if isinstance(ask, str) else (None, None)


SILENCED_FILE = "model-silenced.json"
UNREADABLE = f"a person whom {SILENCED_FILE} does not name"


class ModelSwitch:
    """The switch of the language model; it takes effect at once, even in the middle of an answer.

    `record` writes an entry of the journal. The choice is restored from `folder` and saved there; without a folder it
    ends with the run.
    """

    def __init__(
        self,
        questions: Questions,
        project: Callable[[], Project],
        record: Callable[[Mapping[str, Any]], None],
        folder: Path | None = None,
    ) -> None:
        self._questions, self._project, self._record = questions, project, record
        self._home = Home(folder) if folder else None
        if folder and self._home and (folder / SILENCED_FILE).exists():  # with an unreadable name, too
            found = self._home.read_json(SILENCED_FILE)
            self._questions.silence(str((found.get("by") if isinstance(found, dict) else "") or UNREADABLE))

    @property
    def state(self) -> str | None:
        """`on` or `off`; None if the exhibition has no model."""
        if ANSWERS not in self._project().modules:
            return None
        return "off" if self._questions.silenced else "on"

    def switch(self, by: str, *, on: bool) -> dict[str, Any]:
        """Let the model speak, or silence it, and journal who did so. Return the verdict.

        The verdict has a `text` if the choice could not be saved.
        """
        if self.state is None:
            return refusal("this exhibition has no language model: lumen.yaml has no module `answers`")
        self._questions.silence("" if on else by)
        self._record({"model": self.state, "by": by})
        why = ""
        if self._home and on:
            self._home.remove(SILENCED_FILE)
        elif self._home:
            why = self._home.write_json(SILENCED_FILE, {"by": by})
        kept = {"text": f"until the next start only: {why}"} if why else {}
        return {"verdict": "done", "model": self.state, **kept}


HOW = {"waits": "waits for GO", "goes": "goes", "stays": "stays"}


class DecisionRecords(Protocol):
    """The part of a run's records that keeps people's decisions."""

    def write(self, entry: Mapping[str, Any]) -> None:
        """Write an entry of the journal."""
        ...

    def keep_decisions(self, decisions: Mapping[str, Any]) -> None:
        """Save people's decisions and the waiting events for a run after a crash."""
        ...


class Decisions:
    """People's decisions, each with a line in the transcript.

    `record` writes an entry of the journal, `keep` saves the current decisions and waiting events, and `publish`
    announces on the bus that an event waits, is released or is dropped.
    """

    def __init__(
        self,
        approvals: Approvals,
        narrator: Narrator,
        record: Callable[[Mapping[str, Any]], None],
        keep: Callable[[Mapping[str, Any]], None],
        publish: Callable[[str, HeldEvent, str], object] = lambda _how, _held, _why: None,
    ) -> None:
        self._approvals, self._narrator, self._record, self._keep = approvals, narrator, record, keep
        self._publish = publish
        approvals.watchers.append(self)

    def recover(self, kept: Any, *, resumed: bool) -> None:
        """Restore the autonomy of a crashed run that is resumed, and report its waiting events, which are lost.

        The saved decisions are then replaced by the current ones.
        """
        match kept:
            case {"autonomy": "ask" | "alone" as level, "waiting": list(waiting)} if resumed:
                self._approvals.autonomy = level
                if level == "alone":
                    self._narrator.line("operator", "autonomy: alone, as before")
                for event in waiting:
                    self._narrator.line("operator", f"{event} waited for GO, and is lost because the engine ended")
                    self._record({"approval": "lost", "event": str(event)})
        if kept:
            self._write()

    def approve(self, id: str, by: str, *, go: bool) -> dict[str, Any]:
        """Release the event with an id if `go`, or else drop it; return the verdict.

        An empty id means the oldest event.
        """
        if self._approvals.decide(id, by, go=go):
            return {"verdict": "done"}
        waiting = ", ".join(f"`{held.id}` ({held.event.name})" for held in self._approvals.waiting)
        return {
            "verdict": "refused",
            "reason": f"no event with the id `{id[:20]}` is waiting for GO: {waiting or 'none is waiting'}",
        }

    def autonomy(self, level: Autonomy, by: str) -> dict[str, Any]:
        """Set whether marked transitions wait for GO; return the verdict."""
        self._narrator.line("operator", f"autonomy: {level}, by {by}")
        self._record({"autonomy": level, "by": by})
        self._approvals.set(level, by)
        self._write()
        return {"verdict": "done", "autonomy": level}

    def approval(self, how: str, held: HeldEvent, why: str) -> None:
        """Report, record, publish and save that an event waits, is released or is dropped."""
        machine, wanted, _ = held.marked
        targets = ", ".join(machine.states[path].name for path in wanted.targets) or "what it does"
        self._narrator.line("operator", f"{held.event.name} {HOW[how]}, to {targets}" + (f": {why}" if why else ""))
        self._record({"approval": how, "id": held.id, "event": held.event.name, "why": why})
        self._publish(how, held, why)
        self._write()

    def _write(self) -> None:
        waiting = [held.event.name for held in self._approvals.waiting]
        self._keep({"autonomy": self._approvals.autonomy, "waiting": waiting})
