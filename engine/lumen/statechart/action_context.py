"""The interface through which compiled actions act on the macrostep that runs them."""

from collections.abc import Mapping
from typing import Any, Protocol

from lumen.expressions import Scope
from lumen.language.commands import BodyCommand, Command
from lumen.language.events import Event


class ActionError(Exception):
    """Raised by an action that can't be executed; the rest of its block is skipped (SCXML 4.9)."""


class ActionContext(Protocol):
    """The part of an `ExecutionContext` that actions use."""

    at: float
    """The time of the macrostep [s]."""
    data: Mapping[str, Any]
    """The values of the context keys."""
    language: str
    """The language in which the robot speaks now."""
    cached_scope: Scope | None
    """The last result of `scope`; None after anything in it has changed."""

    def scope(self) -> Scope:
        """Return the values that an expression can read now, cached in `cached_scope` until one of them changes."""

    def assign(self, key: str, value: Any) -> None:
        """Set a context key; raise ActionError if the value does not have the key's type."""

    def draw(self, count: int) -> int:
        """Return a random whole number from 0 to `count` - 1."""

    def emit(self, command: Command) -> None:
        """Append a command to those of the step."""

    def start(self, command: BodyCommand, *, awaited: bool = False) -> str:
        """Start a command of the robot and return its id; a `do` waits for an `awaited` one."""

    def raise_event(self, event: Event) -> None:
        """Append an event to the internal queue."""

    def raise_error(self, reason: str, where: tuple[str | int, ...]) -> None:
        """Raise error.execution for the action at that place in the YAML."""

    def send(self, id: str, delay: float, event: str, data: Any, to: str) -> None:
        """Set a timer: after `delay` [s] the event arrives as if from outside, or goes to the behaviour `to`.

        `to` is empty for the machine itself. Raises ActionError if too many timers are waiting.
        """

    def cancel_send(self, id: str) -> None:
        """Cancel the `send` with that id if it is not due yet."""

    def wait(self, seconds: float) -> str:
        """Set a timer for a `wait` and return its id."""
