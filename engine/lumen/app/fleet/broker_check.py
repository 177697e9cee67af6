"""Whether a broker has what a fleet needs, asked of the broker itself."""

from typing import Any, NamedTuple

from lumen.app.fleet.brokers import UP
from lumen.app.fleet.keys import EXCHANGE
from lumen.buses.broker import BrokerAddress
from lumen.errors import BusError


class BrokerFinding(NamedTuple):
    """What was looked at, what is wrong with it (empty where nothing is), and what is to be known of it."""

    what: str
    wrong: str = ""
    note: str = ""


def check_broker(url: str, *, house: bool) -> list[BrokerFinding]:
    """What a house's broker (or the centre's) has and lacks; nothing on it is changed."""
    import pika
    from pika.exceptions import AMQPError

    try:
        address = BrokerAddress(url)
        connection = pika.BlockingConnection(address.parameters)
    except (BusError, AMQPError, OSError) as error:
        return [BrokerFinding("the broker", f"it can't be reached: {error or type(error).__name__}")]
    found = [BrokerFinding("the broker", note=f"it answers, {'by TLS' if url.startswith('amqps:') else 'in clear'}")]
    try:
        found.append(_passive(connection, "exchange", EXCHANGE))
        found.append(_passive(connection, "queue" if house else "exchange", UP))
    finally:
        connection.close()
    return found


def _passive(connection: Any, kind: str, name: str) -> BrokerFinding:
    from pika.exceptions import ChannelClosedByBroker

    channel, what = connection.channel(), f"the {kind} {name}"
    try:
        if kind == "exchange":
            channel.exchange_declare(name, passive=True)
            return BrokerFinding(what)
        waiting = channel.queue_declare(name, passive=True).method.message_count
    except ChannelClosedByBroker as error:
        why = "it is not there: import the definitions that `lumen fleet init` writes"
        return BrokerFinding(what, why if error.reply_code == 404 else f"the broker refuses: {error.reply_text}")
    note = f"{waiting:,} messages wait for the line to the centre" if waiting else "nothing waits for the centre"
    return BrokerFinding(what, note=note)
