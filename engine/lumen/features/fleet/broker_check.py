"""Whether a broker has what a fleet needs, asked of the broker itself and of its rabbitmqctl."""

from collections.abc import Iterator
from contextlib import closing
from typing import Any
from urllib.parse import quote

from lumen.errors import BusError
from lumen.features.fleet.broker_certificate import check_certificate
from lumen.features.fleet.broker_finding import BrokerFinding
from lumen.features.fleet.broker_links import check_links
from lumen.features.fleet.broker_rights import IMPORT, compare
from lumen.features.fleet.brokers import CENTRE, OPERATORS, ROBOTS, UP, centre_settings, house_settings
from lumen.features.fleet.keys import EXCHANGE
from lumen.features.fleet.rabbitmqctl import RabbitMQControl
from lumen.features.fleet.settings import Fleet
from lumen.features.rabbitmq.broker import BrokerAddress
from lumen.features.rabbitmq.probe import BrokerProbe

CALLED = "pass the command for this broker: --rabbitmqctl 'sudo rabbitmqctl', or 'ssh HOST sudo rabbitmqctl'"


def check_broker(
    fleet: Fleet, name: str, url: str, control: RabbitMQControl, *, ca: str = ""
) -> Iterator[BrokerFinding]:
    """What the broker at `url` has and lacks as that of a house, or as the centre's; nothing on it is changed.

    Passwords are not compared. The certificate is that of the address in fleet.yaml, signed by who is in the file `ca`.
    """
    try:
        with closing(BrokerProbe(trusting(url, ca))) as probe:
            seen = [_passive(probe, "exchange", EXCHANGE)]
            seen.append(_passive(probe, "queue" if name != CENTRE else "exchange", UP))
    except BusError as error:
        yield BrokerFinding("the broker", str(error))
        return
    yield BrokerFinding("the broker", note=f"it answers, {'with TLS' if url.startswith('amqps:') else 'without TLS'}")
    for told in (fleet.centre if name == CENTRE else fleet.houses[name].broker, url):
        if told.startswith("amqps:"):
            yield check_certificate(BrokerAddress(trusting(told, ca)))
            break
    try:
        found = control.definitions()
    except BusError as error:
        yield from seen
        yield BrokerFinding("users, rights, policies and lines", f"they were not checked: {error}", mend=CALLED)
        return
    yield from (row for row in seen if row.note)
    yield from compare(_wanted(fleet, name), found)
    if name != CENTRE:
        yield from check_links(control)


def trusting(url: str, ca: str) -> str:
    """The address of a broker, with the file of who has signed its certificate."""
    return f"{url}{'&' if '?' in url else '?'}ca={quote(ca)}" if ca and url.startswith("amqps:") else url


def _wanted(fleet: Fleet, name: str) -> Any:
    """The definitions that `lumen fleet init` would write, without any password."""
    if name == CENTRE:
        return centre_settings(fleet, dict.fromkeys((OPERATORS, *fleet.houses), "")).definitions
    return house_settings(fleet, name, {ROBOTS: ""}, "").definitions


def _passive(probe: BrokerProbe, kind: str, name: str) -> BrokerFinding:
    from pika.exceptions import ChannelClosedByBroker

    what = f"the {kind} {name}"
    try:
        with probe.asking() as channel:
            if kind == "exchange":
                channel.exchange_declare(name, passive=True)
                return BrokerFinding(what)
            waiting = channel.queue_declare(name, passive=True).method.message_count
    except ChannelClosedByBroker as error:
        if error.reply_code == 404:
            return BrokerFinding(what, "it is missing", mend=IMPORT)
        return BrokerFinding(what, f"the broker refuses the check: {error.reply_text}")
    note = (
        f"messages waiting for the line to the centre: {waiting:,}" if waiting else "nothing is waiting for the centre"
    )
    return BrokerFinding(what, note=note)
