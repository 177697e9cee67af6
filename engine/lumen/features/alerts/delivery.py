"""One alert, on its way: a webhook, a mail or a program."""

from pathlib import Path

from lumen.features.alerts.alert import Alert, Origin
from lumen.features.alerts.settings import AlertChannel, Mail, Program, Webhook


def deliver(channel: AlertChannel, alert: Alert, origin: Origin, root: Path) -> None:
    """Tell somebody; waits for the network. Raises UndeliveredError, which says why it did not arrive."""
    match channel:
        case Webhook(url):
            from lumen.features.alerts.webhook import post  # each with libraries that few exhibitions need

            post(url, origin.body(alert))
        case Mail():
            from lumen.features.alerts.mail import send_mail

            send_mail(channel, origin.line(alert), origin.body(alert))
        case Program(command):
            from lumen.features.alerts.program import run_program

            run_program(command, origin.body(alert), root)


def address(channel: AlertChannel) -> str:
    """Where it goes, without what may be a secret: a webhook's host, not its path."""
    match channel:
        case Webhook(url):
            return f"the webhook {url if url.startswith('$') else '/'.join(url.split('/')[:3])}"
        case Mail(host=host, to=to):
            return f"{', '.join(to)} by {host}"
        case Program(command):
            return f"the command {command[0]}"
