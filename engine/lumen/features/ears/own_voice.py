"""Tracks the robot's own speech from messages on the bus."""

from collections import deque
from collections.abc import Mapping
from typing import Any, NamedTuple

ECHO = 0.3
"""The time for which the room echoes the robot's voice after its last word [s]."""
LONGEST = 60.0
"""A text without a reported end counts as finished after this long [s], so the robot does not stay deaf."""
MAX_KEPT = 100
"""The maximum number of texts that are kept; a sound lasts at most two minutes."""
_SPOKEN = ("started", "accepted")


class Utterance(NamedTuple):
    """A text that the robot says, empty if it is unknown, from `begin` to `end` [s]."""

    text: str
    begin: float
    end: float


class OwnVoice:
    """Tracks the robot's speech by commands of its behaviour (`state`) and of other programs (`report`)."""

    def __init__(self) -> None:
        self._said: deque[Utterance] = deque(maxlen=MAX_KEPT)
        self._saying: dict[str, Utterance] = {}

    def state(self, body: Any, at: float) -> None:
        """Record that the behaviour's `say` began or ended, from a message received at `at` [s]."""
        match body:
            case {"command": {"verb": "say", "id": str(id), "text": str(text)}}:
                self._begin(id, text, at)
            case {"answer": {"id": str(id)}}:
                self._end(id, at)

    def report(self, body: Any, at: float) -> None:
        """Record that another program's `say` began or ended, from the state of its command received at `at` [s]."""
        match body:
            case {"method": str(method), "id": str(id), "state": str(state)} if method.lower() == "say":
                if state in _SPOKEN:
                    self._begin(id, "", at)
                else:
                    self._end(id, at)

    def during(self, begin: float, end: float) -> list[Utterance]:
        """Return the robot's utterances between two times [s], each with its echo, the earliest first."""
        now = [u._replace(end=min(end, u.begin + LONGEST)) for u in self._saying.values()]
        heard = [u._replace(end=u.end + ECHO) for u in (*self._said, *now)]
        return sorted((u for u in heard if u.begin < end and u.end > begin), key=lambda u: u.begin)

    def _begin(self, id: str, text: str, at: float) -> None:
        known: Mapping[str, Utterance] = self._saying
        if id not in known:
            self._saying[id] = Utterance(text, at, at + LONGEST)
        elif text:
            self._saying[id] = known[id]._replace(text=text)
        while len(self._saying) > MAX_KEPT:
            del self._saying[next(iter(self._saying))]

    def _end(self, id: str, at: float) -> None:
        if spoken := self._saying.pop(id, None):
            self._said.append(spoken._replace(end=min(at, spoken.end)))
