"""The section `alerts:` of lumen.yaml, read into `Alerts`."""

from collections.abc import Mapping
from datetime import time
from typing import Any

from lumen.features.alerts.settings import (
    DEFAULT_INTERVAL,
    KINDS,
    SMTP_PORTS,
    AlertChannel,
    Alerts,
    Mail,
    Program,
    QuietHours,
    Recipient,
    Webhook,
)
from lumen.language.diagnostics import NodePath
from lumen.project.document_report import DocumentReport
from lumen.project.routes import duration

WHERE: NodePath = ("alerts",)


def read_alerts(main: Mapping[str, Any], report: DocumentReport) -> Alerts:
    """Return the alert recipients in the data of lumen.yaml, without recipients that have no valid channel."""
    data = main["alerts"]
    interval = duration(data, "interval", report, WHERE, positive=True)
    usual = _quiet(data)
    found = [_recipient(row, usual, (*WHERE, "to", i)) for i, row in enumerate(data.get("to", ()))]
    known = tuple(recipient for recipient in found if recipient is not None)
    return Alerts(known, DEFAULT_INTERVAL if interval is None else interval)


def _recipient(row: Mapping[str, Any], usual: QuietHours | None, where: NodePath) -> Recipient | None:
    channel = _channel(row)
    if channel is None:
        return None
    quiet = _quiet(row) if "quiet" in row else usual
    return Recipient(channel, tuple(row.get("kinds", KINDS)), quiet, where)


def _channel(row: Mapping[str, Any]) -> AlertChannel | None:
    match row:
        case {"webhook": str(url)}:
            return Webhook(url)
        case {"mail": {"host": str(host), "from": str(sender), "to": str() | list() as to, **more}}:
            security = str(more.get("security", "starttls"))
            port = more.get("port", SMTP_PORTS[security])
            return Mail(
                host, int(float(str(port))), security, sender, (to,) if isinstance(to, str) else tuple(map(str, to))
            )
        case {"command": list(words)}:
            return Program(tuple(words))
    return None


def _quiet(data: Mapping[str, Any]) -> QuietHours | None:
    """Return the quiet hours in a row, such as `22:00-07:00`; None if they are `never` or missing."""
    text = data.get("quiet", "never")
    if text == "never":
        return None
    begin, _, end = text.partition("-")
    return QuietHours(_time(begin), _time(end))


def _time(text: str) -> time:
    hours, minutes = map(int, text.split(":"))
    return time(hours, minutes)
