"""The recipients of alerts, with the kinds, quiet hours and channels of their alerts."""

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
"""The kinds of alerts, with their descriptions."""

DEFAULT_INTERVAL = 900.0
"""The default time for which an equal alert is not repeated [s]."""
SMTP_PORTS: Mapping[str, int] = {"starttls": 587, "tls": 465, "none": 25}
"""A mail server's usual port for each type of encryption."""


@dataclass(frozen=True, slots=True)
class Webhook:
    """A POST with JSON to `url`, or to the URL in the environment variable NAME if `url` is `$NAME`."""

    url: str


@dataclass(frozen=True, slots=True)
class Mail:
    """An email, sent by SMTP."""

    host: str
    port: int
    security: str
    """A key of `SMTP_PORTS`."""
    sender: str
    to: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Program:
    """A program with its arguments, which receives JSON on its standard input; no shell is involved."""

    command: tuple[str, ...]


AlertChannel: TypeAlias = Webhook | Mail | Program


@dataclass(frozen=True, slots=True)
class QuietHours:
    """The hours from `begin` to `end`, two times of day; across midnight if `end` is earlier."""

    begin: time
    end: time

    def hold(self, now: time) -> bool:
        """Return whether this time of day is in the quiet hours."""
        if self.begin <= self.end:
            return self.begin <= now < self.end
        return now >= self.begin or now < self.end


@dataclass(frozen=True, slots=True)
class Recipient:
    """A recipient of alerts, and its path `where` in lumen.yaml."""

    channel: AlertChannel
    kinds: tuple[str, ...] = tuple(KINDS)
    """The kinds of alerts to send."""
    quiet: QuietHours | None = None
    """The hours in which alerts are held back; None for none."""
    where: NodePath = field(default=(), compare=False)


@dataclass(frozen=True, slots=True)
class Alerts:
    """The recipients; each recipient receives equal alerts at most once per `interval` [s]."""

    to: tuple[Recipient, ...] = ()
    interval: float = DEFAULT_INTERVAL
