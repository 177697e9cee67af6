"""An alert about trouble, for people who are not at the exhibition."""

import platform
from datetime import datetime
from typing import Any, NamedTuple

from lumen.features.alerts.settings import KINDS
from lumen.language.iso_time import iso_time

TEST = "test"
"""The kind of test alerts."""


class Alert(NamedTuple):
    """A report of one problem, in a line without visitors' names or words."""

    kind: str
    """A key of `KINDS`, or `TEST`."""
    text: str
    about: str = ""
    """Distinguishes alerts of the same kind, for example by the lost part's name."""
    at: float = 0.0
    """The Unix time of the event [s]."""
    first: float = 0.0
    """The Unix time of the first equal event that was held back [s]."""
    times: int = 1
    """The number of equal events since `first`."""

    def after(self, earlier: "Alert") -> "Alert":
        """Return this alert merged with an earlier, equal alert that was held back."""
        return self._replace(first=earlier.first, times=earlier.times + self.times)


class Origin(NamedTuple):
    """The sender of an alert."""

    exhibition: str
    """The exhibition's name."""
    robot: str
    """The robot's name."""
    parts: tuple[str, ...] = ()
    """The exhibition's parts in this process."""

    def body(self, alert: Alert) -> dict[str, Any]:
        """Return the alert as JSON data. Its `text` is complete, because chat programs show only that field."""
        return {
            "kind": alert.kind,
            "text": self.line(alert),
            "meaning": KINDS.get(alert.kind, "an operator is testing whether alerts arrive"),
            "about": alert.about,
            "exhibition": self.exhibition,
            "robot": self.robot,
            "parts": list(self.parts),
            "host": platform.node(),
            "at": iso_time(alert.at, "seconds", offset=True),
            "first": iso_time(alert.first, "seconds", offset=True),
            "count": alert.times,
        }

    def line(self, alert: Alert) -> str:
        """Return a line such as `NAO: it fell and has not got up (3 times since 10:02)`."""
        held = f" ({alert.times} times since {_clock(alert.first)})" if alert.times > 1 else ""
        return one_line(f"{self.robot}: {alert.text}{held}")


def one_line(text: str) -> str:
    """Return the first 500 characters of the text on one line.

    Unprintable characters, which could control a terminal or an email header, become spaces.
    """
    return " ".join("".join(sign if sign.isprintable() else " " for sign in text).split())[:500]


def _clock(at: float) -> str:
    return datetime.fromtimestamp(at).strftime("%H:%M")
