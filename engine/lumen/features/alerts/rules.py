"""Rules for alerts: reachable recipients, and encrypted connections."""

import re
from collections.abc import Mapping
from typing import Any
from urllib.parse import urlsplit

from lumen.features.alerts.reading import WHERE
from lumen.features.alerts.settings import Alerts, Mail, Recipient, Webhook
from lumen.language.addresses import credentials_of, loopback
from lumen.language.diagnostics import ERROR, WARNING, Code, NodePath
from lumen.lint.routes import PASSWORD_IN_FILE
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft

ALERT_ADDRESS = Code("alert-address", "alerts", ERROR, "the value of a `webhook` is not a valid web address")
ALERT_IN_CLEAR = Code("alert-in-clear", "alerts", WARNING, "alerts are sent unencrypted: others can read them")
ALERT_QUIET = Code("alert-quiet", "alerts", ERROR, "quiet hours begin and end at the same time")
ALERT_TO_NOBODY = Code("alert-to-nobody", "alerts", WARNING, "alerts have no recipient")
ALERT_WAY = Code(
    "alert-way", "alerts", ERROR, "a recipient does not have exactly one of `webhook`, `mail` and `command`"
)

WAYS = ("webhook", "mail", "command")
_VARIABLE = re.compile(r"\$[A-Za-z_][A-Za-z0-9_]*")


def check(draft: ProjectDraft) -> None:
    """Report errors in alert recipients and quiet hours."""
    settings, report = draft.settings, draft.main
    data = report.document.data.get("alerts") if report and isinstance(report.document.data, Mapping) else None
    if settings is None or report is None or not isinstance(data, Mapping):
        return
    _quiet(report, data, WHERE)
    rows = data.get("to")
    if rows == []:
        report(
            ALERT_TO_NOBODY,
            (*WHERE, "to"),
            "the list of recipients is empty",
            "write at least one recipient, or delete `alerts`",
        )
    for i, row in enumerate(rows if isinstance(rows, list) else ()):
        if isinstance(row, Mapping):
            _way(report, row, (*WHERE, "to", i))
            _quiet(report, row, (*WHERE, "to", i))
    for recipient in settings.section(Alerts).to:
        _reached(report, recipient)


def _way(report: DocumentReport, row: Mapping[str, Any], where: NodePath) -> None:
    """Report a recipient without exactly one of `WAYS`, unless an error in this recipient is already reported."""
    said = [way for way in WAYS if way in row]
    if len(said) == 1 or any(path[: len(where)] == where for path in report.pruned):
        return
    hint = "write `webhook: URL`, `mail: {host, from, to}` or `command: [PROGRAM, …]`"
    if said:
        report(
            ALERT_WAY,
            (*where, said[1]),
            f"this recipient has both `{said[0]}` and `{said[1]}`",
            "split it into two recipients",
            key=True,
        )
    else:
        report(ALERT_WAY, where, "this recipient has no `webhook`, `mail` or `command`", hint)


def _quiet(report: DocumentReport, row: Mapping[str, Any], where: NodePath) -> None:
    begin, _, end = str(row.get("quiet", "")).partition("-")
    if end and begin.zfill(5) == end.zfill(5):
        hint = "write two different times, such as `22:00-07:00`, or `never`"
        report(ALERT_QUIET, (*where, "quiet"), f"the quiet hours begin and end at {begin}", hint)


def _reached(report: DocumentReport, recipient: Recipient) -> None:
    match recipient.channel:
        case Webhook(url) if url.startswith("$"):
            if not _VARIABLE.fullmatch(url):
                hint = "write `$` and a name, such as `$LUMEN_ALERT_URL`"
                report(
                    ALERT_ADDRESS,
                    (*recipient.where, "webhook"),
                    f"`{url}` is not the name of an environment variable",
                    hint,
                )
        case Webhook(url):
            _web(report, url, (*recipient.where, "webhook"))
        case Mail(host=host, security="none") if not loopback(host):
            hint = "write `starttls` or `tls`: without encryption, Lumen does not send the name and the password"
            report(ALERT_IN_CLEAR, (*recipient.where, "mail", "security"), f"emails to {host} are not encrypted", hint)


def _web(report: DocumentReport, url: str, where: NodePath) -> None:
    try:
        parts = urlsplit(url)
        port_or_none = parts.port
    except ValueError:
        parts, port_or_none = urlsplit(""), None
    if parts.username is not None or (not parts.scheme and credentials_of(url)):
        hint = "write `webhook: $LUMEN_ALERT_URL`, and put the address into that environment variable"
        report(PASSWORD_IN_FILE, where, "a user name and a password are in a file that others can read", hint)
    elif parts.scheme not in ("http", "https") or not parts.hostname or port_or_none == 0 or re.search(r"\s", url):
        hint = "write an address such as https://chat.museum.example/hooks/lumen, or $NAME for a variable that holds it"
        report(ALERT_ADDRESS, where, f"`{url}` is not a web address", hint)
    elif parts.scheme == "http" and not loopback(parts.hostname):
        report(ALERT_IN_CLEAR, where, f"messages to {parts.hostname} are not encrypted", "write https://")
