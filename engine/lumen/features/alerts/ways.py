"""Delivers an alert by email, to a program's standard input, or as a POST with JSON."""

import json
import os
import signal
import smtplib
import ssl
import subprocess
import urllib.error
import urllib.request
from collections.abc import Sequence
from contextlib import suppress
from email.message import EmailMessage
from email.utils import formatdate, make_msgid
from http.client import HTTPException
from pathlib import Path
from typing import Any

from lumen.errors import UndeliveredError
from lumen.features.alerts.settings import Mail

MAIL_TIMEOUT = 20.0
"""The maximum wait for each answer from the mail server [s]."""
USER, PASSWORD = "LUMEN_SMTP_USER", "LUMEN_SMTP_PASSWORD"
"""The environment variables with the mail server's user and password; without a user, Lumen does not log in."""


def send_mail(mail: Mail, line: str, body: dict[str, Any]) -> None:
    """Send an email to all recipients of `mail`. Raises UndeliveredError if that fails for any recipient."""
    message = EmailMessage()
    message["Subject"], message["From"], message["To"] = f"[Lumen] {line}", mail.sender, ", ".join(mail.to)
    message["Date"], message["Message-ID"] = formatdate(), make_msgid(domain="lumen.invalid")
    message.set_content(f"{line}\n\n{json.dumps(body, indent=2, ensure_ascii=False)}\n")
    try:
        with _connected(mail) as server:
            refused = server.send_message(message)
    except smtplib.SMTPRecipientsRefused as error:
        final = all(code >= 500 for code, _ in error.recipients.values())
        raise UndeliveredError(f"the mail server refuses {', '.join(error.recipients)}", final=final) from None
    except smtplib.SMTPResponseException as error:
        said = error.smtp_error.decode("utf-8", "replace") if isinstance(error.smtp_error, bytes) else error.smtp_error
        raise UndeliveredError(
            f"the mail server answers {error.smtp_code} {said[:200]}", final=error.smtp_code >= 500
        ) from None
    except ValueError as error:
        raise UndeliveredError(str(error), final=True) from None
    except (smtplib.SMTPException, OSError) as error:
        raise UndeliveredError(f"the mail server can't be used: {error}") from None
    if refused:
        raise UndeliveredError(
            f"the mail server refuses {', '.join(refused)}, but accepted the mail for the others", final=True
        )


def _connected(mail: Mail) -> smtplib.SMTP:
    """Return the connected server, encrypted and logged in as configured.

    Raises the errors of smtplib, and ValueError if the password would be sent unencrypted.
    """
    name = os.environ.get(USER, "")
    if name and mail.security == "none":
        raise ValueError(f"the password in {PASSWORD} is not sent unencrypted: write `security: starttls` or `tls`")
    if mail.security == "tls":
        server: smtplib.SMTP = smtplib.SMTP_SSL(
            mail.host, mail.port, timeout=MAIL_TIMEOUT, context=ssl.create_default_context()
        )
    else:
        server = smtplib.SMTP(mail.host, mail.port, timeout=MAIL_TIMEOUT)
    try:
        if mail.security == "starttls":
            server.starttls(context=ssl.create_default_context())
        if name:
            server.login(name, os.environ.get(PASSWORD, ""))
    except BaseException:
        server.close()
        raise
    return server


PROGRAM_TIMEOUT = 30.0
"""The time limit of the program [s], after which it is killed."""


def run_program(command: Sequence[str], body: dict[str, Any], root: Path) -> None:
    """Run the program in the project's folder with `body` as JSON on its standard input, and wait for its end.

    Then kill all processes that it has started. Raises UndeliveredError unless its exit code is 0.
    """
    name = command[0]
    if os.path.basename(name) != name:
        name = str(root / name)
    try:
        process = subprocess.Popen(
            [name, *command[1:]],
            cwd=root,
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            start_new_session=True,
        )
    except (OSError, ValueError) as error:
        raise UndeliveredError(
            f"the program can't be run: {getattr(error, 'strerror', None) or error}", final=True
        ) from None
    try:
        _, said = process.communicate(json.dumps(body).encode(), PROGRAM_TIMEOUT)
    except subprocess.TimeoutExpired:
        raise UndeliveredError(f"the program did not end within {PROGRAM_TIMEOUT:g} s") from None
    finally:
        _end(process)
    if process.returncode:
        last = said.decode("utf-8", "replace").strip().splitlines()[-1:]
        raise UndeliveredError(
            f"the program ended with exit code {process.returncode}{': ' * bool(last)}{''.join(last)[:200]}"
        )


def _end(process: "subprocess.Popen[bytes]") -> None:
    """Kill the program and all processes that it has started."""
    if process.poll() is None or hasattr(os, "killpg"):
        with suppress(OSError):
            os.killpg(process.pid, signal.SIGKILL) if hasattr(os, "killpg") else process.kill()
    process.wait()
    for pipe in (process.stdin, process.stderr):
        if pipe:
            with suppress(OSError):
                pipe.close()


POST_TIMEOUT = 10.0
"""The maximum wait for each answer from the web server [s]."""
PASSING = (408, 425, 429, *range(500, 600))
"""The HTTP statuses after which another attempt may succeed."""
TOKEN = "LUMEN_ALERT_TOKEN"
"""The environment variable with the token for all webhooks, which is sent as `Authorization: Bearer`."""


class _Stay(urllib.request.HTTPRedirectHandler):
    """Rejects redirects, which may lead to any server, and would turn a POST into a GET."""

    def redirect_request(self, *arguments: Any) -> None:
        """Return None, which rejects the redirect."""


def post(url: str, body: dict[str, Any]) -> None:
    """Send the body as JSON to `url`, or to the URL in the environment variable NAME if `url` is `$NAME`.

    Raises UndeliveredError unless the server answers with a status from 200 to 299.
    """
    if url.startswith("$"):
        url = _of_variable(url[1:])
    head = {"Content-Type": "application/json", "User-Agent": "lumen"}
    if token := os.environ.get(TOKEN):
        head["Authorization"] = f"Bearer {token}"
    try:
        request = urllib.request.Request(url, json.dumps(body).encode(), head, method="POST")
        with urllib.request.build_opener(_Stay).open(request, timeout=POST_TIMEOUT):
            pass
    except urllib.error.HTTPError as error:
        error.close()
        raise UndeliveredError(
            f"the server answers {error.code} {error.reason}", final=error.code not in PASSING
        ) from None
    except urllib.error.URLError as error:
        raise UndeliveredError(f"the server can't be reached: {error.reason}") from None
    except (TimeoutError, ConnectionError) as error:
        raise UndeliveredError(f"the server can't be reached: {error}") from None
    except (OSError, ValueError, HTTPException) as error:  # its text may contain the URL, which may be secret
        raise UndeliveredError(f"the request failed: {type(error).__name__}") from None


def _of_variable(name: str) -> str:
    """Return the URL in an environment variable.

    Raises UndeliveredError if it is missing or invalid, without quoting the URL, which may be secret.
    """
    url = os.environ.get(name, "").strip()
    if not url:
        raise UndeliveredError(f"the environment variable {name} is not set", final=True)
    if not url.startswith(("https://", "http://")):
        why = f"the address in the environment variable {name} must begin with https:// or http://"
        raise UndeliveredError(why, final=True)
    return url
