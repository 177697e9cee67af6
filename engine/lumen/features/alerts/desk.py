"""Sends each alert to all recipients of its kind."""

import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path

from lumen.errors import UndeliveredError
from lumen.features.alerts.alert import TEST, Alert, Origin, one_line
from lumen.features.alerts.courier import Courier
from lumen.features.alerts.settings import AlertChannel, Alerts, Mail, Program, Recipient, Webhook


def deliver(channel: AlertChannel, alert: Alert, origin: Origin, root: Path) -> None:
    """Deliver an alert, and wait for the network, or for a program, which runs in `root`.

    Raises UndeliveredError if the alert did not arrive.
    """
    match channel:
        case Webhook(url):
            from lumen.features.alerts.ways import post  # it imports libraries that few exhibitions need

            post(url, origin.body(alert))
        case Mail():
            from lumen.features.alerts.ways import send_mail

            send_mail(channel, origin.line(alert), origin.body(alert))
        case Program(command):
            from lumen.features.alerts.ways import run_program

            run_program(command, origin.body(alert), root)


def address(channel: AlertChannel) -> str:
    """Return a recipient's address without secrets, such as a webhook's host without its path."""
    match channel:
        case Webhook(url):
            return f"the webhook {url if url.startswith('$') else '/'.join(url.split('/')[:3])}"
        case Mail(host=host, to=to):
            return f"{', '.join(to)} by {host}"
        case Program(command):
            return f"the command {command[0]}"


CLOSE_TIMEOUT = 10.0
"""The time limit for delivering the waiting alerts of a desk or recipient that ends [s]."""


class AlertDesk:
    """Sends alerts to their recipients; only `close` and `test` wait.

    `tell` receives each failure with its recipient. `root` is the project's folder. Callers must pass texts without
    visitors' names or words.
    """

    def __init__(self, alerts: Alerts, origin: Origin, root: Path, tell: Callable[[str], None]) -> None:
        self._origin, self._root, self._tell = origin, root, tell
        self._alerts, self._couriers = Alerts(), list[Courier]()
        self.use(alerts)

    def __call__(self, kind: str, text: str, about: str = "") -> None:
        """Send an alert about a present event; `about` distinguishes alerts of the same kind."""
        now = time.time()
        alert = Alert(kind, one_line(text), about, now, now)
        for courier in self._couriers:
            courier.put(alert)

    def use(self, alerts: Alerts) -> None:
        """Use these recipients from now on; previous recipients still receive waiting alerts, except in quiet hours."""
        if alerts == self._alerts:
            return
        old, self._alerts = self._couriers, alerts
        self._couriers = [
            Courier(recipient, alerts.interval, partial(self._deliver, recipient), partial(self._failed, recipient))
            for recipient in alerts.to
        ]
        for courier in old:
            courier.end(time.monotonic() + CLOSE_TIMEOUT)

    def test(self) -> Iterator[tuple[str, str]]:
        """Send a test alert to each recipient, even in quiet hours, and wait for the result.

        Yield each address with the error, which is empty after success.
        """
        now = time.time()
        alert = Alert(TEST, "this is a test: you will receive this robot's alerts", "", now, now)
        for recipient in self._alerts.to:
            try:
                self._deliver(recipient, alert)
                yield address(recipient.channel), ""
            except UndeliveredError as error:
                yield address(recipient.channel), one_line(str(error))

    def close(self) -> None:
        """Deliver waiting alerts for at most CLOSE_TIMEOUT; further calls do nothing."""
        until = time.monotonic() + CLOSE_TIMEOUT
        couriers, self._couriers = self._couriers, []
        self._alerts = Alerts()
        for courier in couriers:
            courier.end(until)
        for courier in couriers:
            courier.join()

    def _deliver(self, recipient: Recipient, alert: Alert) -> None:
        deliver(recipient.channel, alert, self._origin, self._root)

    def _failed(self, recipient: Recipient, why: str) -> None:
        self._tell(f"{address(recipient.channel)} did not receive the alert: {one_line(why)}")
