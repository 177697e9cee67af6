"""Alerts as emails."""

import json
import os
import smtplib
import ssl
from email.message import EmailMessage
from email.utils import formatdate, make_msgid
from typing import Any

from lumen.errors import UndeliveredError
from lumen.features.alerts.settings import Mail

MAIL_TIMEOUT = 20.0
"""The time for which the server may be silent [s]."""
USER, PASSWORD = "LUMEN_SMTP_USER", "LUMEN_SMTP_PASSWORD"
"""The environment variables with the user and the password of the mail server; without a user there is no login."""


def send_mail(mail: Mail, line: str, body: dict[str, Any]) -> None:
    """Send the mail to all recipients. Raises UndeliveredError if the server refuses it for any of them."""
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
    """Return the connected server, encrypted and logged in as configured. Raises what smtplib raises."""
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
