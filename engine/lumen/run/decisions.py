"""What people decide while an exhibition runs: what waits for approval goes or stays, and whether anything waits."""

from collections.abc import Callable, Mapping
from typing import Any, Protocol

from lumen.language.approvals import Autonomy
from lumen.run.approvals import Approvals, HeldEvent
from lumen.run.narrator import Narrator

HOW = {"waits": "waits for GO", "goes": "goes", "stays": "stays"}


class DecisionRecords(Protocol):
    """The records of a run, as far as people's decisions are kept in them."""

    def write(self, entry: Mapping[str, Any]) -> None:
        """Keep an entry of the journal."""
        ...

    def keep_decisions(self, decisions: Mapping[str, Any]) -> None:
        """Keep what people decided, and what waits for them, for the run after a crash."""
        ...


class Decisions:
    """Lets people decide, and tells of it: a line of the transcript, and by `record` an entry of the journal.

    `keep` has it written what was decided and what waits; `publish` tells the bus what became of each event.
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
        """Go on with the autonomy that a run had which ended without notice, and say what it lost."""
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
        """GO, or not, for the event of that id; of an empty one for what waits longest."""
        if self._approvals.decide(id, by, go=go):
            return {"verdict": "done"}
        waiting = ", ".join(f"`{held.id}` ({held.event.name})" for held in self._approvals.waiting)
        return {
            "verdict": "refused",
            "reason": f"no event with the id `{id[:20]}` is waiting for GO: {waiting or 'none is waiting'}",
        }

    def autonomy(self, level: Autonomy, by: str) -> dict[str, Any]:
        """Whether marked transitions wait for GO from now on."""
        self._narrator.line("operator", f"autonomy: {level}, by {by}")
        self._record({"autonomy": level, "by": by})
        self._approvals.set(level, by)
        self._write()
        return {"verdict": "done", "autonomy": level}

    def approval(self, how: str, held: HeldEvent, why: str) -> None:
        """Tell what became of an event that waited for approval, and keep it."""
        machine, wanted, _ = held.marked
        targets = ", ".join(machine.states[path].name for path in wanted.targets) or "what it does"
        self._narrator.line("operator", f"{held.event.name} {HOW[how]}, to {targets}" + (f": {why}" if why else ""))
        self._record({"approval": how, "id": held.id, "event": held.event.name, "why": why})
        self._publish(how, held, why)
        self._write()

    def _write(self) -> None:
        waiting = [held.event.name for held in self._approvals.waiting]
        self._keep({"autonomy": self._approvals.autonomy, "waiting": waiting})
