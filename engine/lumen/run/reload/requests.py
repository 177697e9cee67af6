"""Operators' requests about saved files: messages on `lumen.config.command`."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from lumen.errors import BusError, UsageError
from lumen.language.diagnostics import did_you_mean
from lumen.language.routing_keys import CONFIG_COMMAND, CONFIG_STATUS, INTERNAL_ALIASES, key_of_robot
from lumen.ports import Bus, Message

COMMAND, STATUS = INTERNAL_ALIASES[CONFIG_COMMAND], INTERNAL_ALIASES[CONFIG_STATUS]
"""The keys of requests and of their results on a bus with one robot."""
REQUESTS = ("reload", "apply", "try", "refuse", "rollback", "dry-run", "status", "stop")
"""The verbs of requests."""
WAITING = 100
"""The number of requests that may wait for a tick; one more drops the oldest."""


def command_key(robot: str) -> str:
    """Return the key of requests to a robot's exhibition."""
    return key_of_robot(CONFIG_COMMAND, robot)


def status_key(robot: str) -> str:
    """Return the key on which a robot's exhibition publishes the results."""
    return key_of_robot(CONFIG_STATUS, robot)


@dataclass(frozen=True)
class ReloadRequest:
    """A request about saved files."""

    verb: str
    """One of `REQUESTS`."""
    now: bool
    """Whether not to wait for current actions."""
    answer: Callable[[Any], None]
    """Sends a body to the sender of the request."""
    between: bool = False
    """Whether to wait for the end of a visit, without a time limit."""


def request_from(message: Message, bus: Bus) -> ReloadRequest:
    """Return the request in a message. Raises UsageError, with advice, for anything else."""
    body = message.body
    if not isinstance(body, dict) or not isinstance(verb := body.get("command"), str):
        raise UsageError(f'send a body such as {{"command": "reload"}}, with one of the commands {", ".join(REQUESTS)}')
    if verb not in REQUESTS:
        raise UsageError(f"there is no command `{verb[:40]}`: {did_you_mean(verb[:40], REQUESTS, 'there are')}")
    if not isinstance(body.get("now", False), bool):
        raise UsageError("`now` must be true or false")
    return ReloadRequest(verb, body.get("now", False), answering(message, bus))


def answering(message: Message, bus: Bus) -> Callable[[Any], None]:
    """Return a function that replies to a message with a body; it does nothing if the bus is gone."""

    def answer(body: Any) -> None:
        try:
            bus.reply(message, body)
        except BusError:
            return

    return answer
