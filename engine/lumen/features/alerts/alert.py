"""Something that people who are not there have to know."""

import platform
from datetime import datetime
from typing import Any, NamedTuple

from lumen.features.alerts.settings import KINDS
from lumen.language.iso_time import iso_time

TEST = "test"
"""The kind of those that are sent to see whether they arrive."""


class Alert(NamedTuple):
    """What happened, in a line made of our own words: of a visitor, or of what they said, it holds nothing.

    `about` tells those of one kind apart (the part that is gone); of the same kind and `about` all after the first are
    counted in `times` since `first`, where they were held back. Times are Unix times.
    """

    kind: str
    text: str
    about: str = ""
    at: float = 0.0
    first: float = 0.0
    times: int = 1

    def after(self, earlier: "Alert") -> "Alert":
        """This one, with those before it that were held back."""
        return self._replace(first=earlier.first, times=earlier.times + self.times)


class Origin(NamedTuple):
    """Who tells: the exhibition, its robot, and which parts of it this process is."""

    exhibition: str
    robot: str
    parts: tuple[str, ...] = ()

    def body(self, alert: Alert) -> dict[str, Any]:
        """The alert as JSON; `text` alone says it all, as chat programs want it."""
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
        """`NAO: it fell and has not got up (3 times since 10:02)`."""
        held = f" ({alert.times} times since {_clock(alert.first)})" if alert.times > 1 else ""
        return one_line(f"{self.robot}: {alert.text}{held}")


def one_line(text: str) -> str:
    """The text on one line, without signs that would steer a terminal or a mail's head."""
    return " ".join("".join(sign if sign.isprintable() else " " for sign in text).split())[:500]


def _clock(at: float) -> str:
    return datetime.fromtimestamp(at).strftime("%H:%M")
