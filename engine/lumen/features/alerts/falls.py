"""Whether a robot that fell gets up again."""

from lumen.language.commands import Command, Posture, Start, Wake
from lumen.language.events import Event

TIME_TO_RISE = 60.0
"""How long a robot may take to get up [s]; one that gets up by itself takes 20."""


class FallWatch:
    """Hears what the robot is told and what it answers; `tick` says once of each fall that it is not got up from."""

    def __init__(self) -> None:
        self._fallen: float | None = None
        self._rising: set[str] = set()
        self._failed = False

    def performing(self, command: Command) -> None:
        match command:
            case Start(id, Posture() | Wake()):
                self._rising.add(id)

    def answered(self, event: Event, now: float) -> None:
        kind, _, id = event.name.partition(".command.")
        if event.name == "fallen" and self._fallen is None:
            self._fallen, self._failed, self._rising = now, False, set()
        elif id in self._rising:
            self._rising.discard(id)
            self._failed = self._failed or kind == "error"
            if kind == "done":
                self._fallen, self._failed = None, False

    def tick(self, now: float) -> str:
        """Why it does not get up, empty where it stands, may still get up, or that was said."""
        if self._fallen is None:
            return ""
        why = "it fell and can't get up" if self._failed else "it fell and has not got up"
        if not self._failed and now - self._fallen < TIME_TO_RISE:
            return ""
        self._fallen, self._failed = None, False
        return why
