"""Decisions of people while an exhibition runs: approvals, and whether events wait for them at all."""

from collections.abc import Callable, Mapping
from typing import Any, Protocol

from lumen.language.approvals import Autonomy
from lumen.run.approvals import Approvals, HeldEvent
from lumen.run.narrator import Narrator

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

    `record` writes an entry of the journal, `keep` saves the current decisions and waiting events, and `publish` sends
    to the bus how each event was decided.
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
        """Restore the autonomy of a run that crashed, and report the events that waited then and are lost."""
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
        """Let the event with an id go or stay (the oldest for an empty id); return the verdict."""
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
        """Report and record that an event waits, goes or stays."""
        machine, wanted, _ = held.marked
        targets = ", ".join(machine.states[path].name for path in wanted.targets) or "what it does"
        self._narrator.line("operator", f"{held.event.name} {HOW[how]}, to {targets}" + (f": {why}" if why else ""))
        self._record({"approval": how, "id": held.id, "event": held.event.name, "why": why})
        self._publish(how, held, why)
        self._write()

    def _write(self) -> None:
        waiting = [held.event.name for held in self._approvals.waiting]
        self._keep({"autonomy": self._approvals.autonomy, "waiting": waiting})
