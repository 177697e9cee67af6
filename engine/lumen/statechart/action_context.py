"""What executable content may ask of the macrostep that it is part of: all that compiled actions know of it."""

from collections.abc import Mapping
from typing import Any, Protocol

from lumen.expressions import Scope
from lumen.language.commands import BodyCommand, Command
from lumen.language.events import Event


class ActionError(Exception):
    """An action can't be done as it is written; the rest of its block is skipped (SCXML 4.9)."""


class ActionContext(Protocol):
    """The part of an `ExecutionContext` that actions use; `at` is the time of the macrostep [s]."""

    at: float
    data: Mapping[str, Any]
    language: str
    cached_scope: Scope | None

    def scope(self) -> Scope:
        """What an expression sees now; kept in `cached_scope` until something in it changes."""

    def assign(self, key: str, value: Any) -> None:
        """Give a context key another value; raises ActionError where it is of another type."""

    def draw(self, count: int) -> int:
        """One of `count` alternatives, at random."""

    def emit(self, command: Command) -> None:
        """Ask the world for something."""

    def start(self, command: BodyCommand, *, awaited: bool = False) -> str:
        """Start a command of the robot; its id."""

    def raise_event(self, event: Event) -> None:
        """Append to the internal queue."""

    def raise_error(self, reason: str, where: tuple[str | int, ...]) -> None:
        """Raise error.execution."""

    def send(self, id: str, delay: float, event: str, data: Any, to: str) -> None:
        """Set a timer: the event comes from outside after `delay` [s], or goes `to` another behaviour."""

    def cancel_send(self, id: str) -> None:
        """Take back what was sent under that id and has not come yet."""

    def wait(self, seconds: float) -> str:
        """Set a timer for a `wait`; its id."""
