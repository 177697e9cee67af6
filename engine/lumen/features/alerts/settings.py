"""Whom an exhibition tells of what goes wrong while nobody looks, of what, when, and how."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import time
from typing import TypeAlias

from lumen.language.diagnostics import NodePath

KINDS: Mapping[str, str] = {
    "fallen": "the robot fell and has not got up",
    "stopped": "a person stopped the robot",
    "lost": "the robot, the brain or a module is lost, or back",
    "broker": "the message broker can't be reached, or accepts no messages",
    "refused": "saved files were refused, or rolled back",
    "start": "the exhibition could not start, or an error ended it",
    "crashed": "the exhibition ended unexpectedly, or a part of it failed permanently",
    "disk": "the disk is full, or Lumen can't write to it",
    "battery": "the robot's battery is low",
    "hot": "the robot's motors are hot",
}
"""What can be told, by the word for it."""

DEFAULT_INTERVAL = 900.0
"""How long the same is told once only [s], where the project does not say."""
SMTP_PORTS: Mapping[str, int] = {"starttls": 587, "tls": 465, "none": 25}
"""The usual port for each way of a mail to be secured."""


@dataclass(frozen=True, slots=True)
class Webhook:
    """A POST with JSON to `url`; `$NAME` is the URL that the environment variable of that name holds."""

    url: str


@dataclass(frozen=True, slots=True)
class Mail:
    """A mail by SMTP; `security` is one of `SMTP_PORTS`."""

    host: str
    port: int
    security: str
    sender: str
    to: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Program:
    """A program with its arguments, which gets JSON on its standard input; no shell reads them."""

    command: tuple[str, ...]


AlertChannel: TypeAlias = Webhook | Mail | Program


@dataclass(frozen=True, slots=True)
class QuietHours:
    """From one time of day to another, over midnight where the second is the earlier one."""

    begin: time
    end: time

    def hold(self, now: time) -> bool:
        """Whether it is quiet at this time of day."""
        if self.begin <= self.end:
            return self.begin <= now < self.end
        return now >= self.begin or now < self.end


@dataclass(frozen=True, slots=True)
class Recipient:
    """Somebody who is told: how, of which `kinds`, and when not."""

    channel: AlertChannel
    kinds: tuple[str, ...] = tuple(KINDS)
    quiet: QuietHours | None = None
    where: NodePath = field(default=(), compare=False)


@dataclass(frozen=True, slots=True)
class Alerts:
    """Who is told; each of them the same once in `interval` [s]."""

    to: tuple[Recipient, ...] = ()
    interval: float = DEFAULT_INTERVAL
