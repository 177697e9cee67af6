"""Which states are active, by what the brain publishes."""

from typing import Any

LOST_AFTER = 4.0
"""The states of a brain that is silent for longer no longer count [s]."""


class ActiveStates:
    """The active states of one robot's behaviour, from the routes `state` and `presence`.

    A brain that has not announced itself, such as one on a bus within this process, is never lost.
    """

    def __init__(self, robot: str) -> None:
        self._robot = robot
        self._names: frozenset[str] | None = None
        self._until = float("inf")

    def state(self, body: Any, at: float) -> None:
        """Read a message about the behaviour that came at a time [s]; only those after a step have `states`."""
        match body:
            case {"robot": self._robot, "states": list(states)}:
                self._names = frozenset(map(str, states))
                self._until = max(self._until, at + LOST_AFTER)

    def presence(self, body: Any, at: float) -> None:
        """Read the announcement of a process."""
        match body:
            case {"robot": self._robot, "parts": list(parts), "state": "here"} if "brain" in parts:
                self._until = at + LOST_AFTER

    def names(self, at: float) -> frozenset[str] | None:
        """The names of the active states at a time [s], as `state` has them; None if they are unknown."""
        if at > self._until:
            self._names = None
        return self._names
