"""Whether the two lines of a house to the centre run, as its broker sees them."""

from collections.abc import Iterator, Mapping
from typing import Any

from lumen.errors import BusError
from lumen.features.fleet.broker_finding import BrokerFinding
from lumen.features.fleet.broker_rights import IMPORT
from lumen.features.fleet.brokers import UP
from lumen.features.fleet.keys import EXCHANGE
from lumen.features.fleet.rabbitmqctl import RabbitMQControl

ENABLE = "rabbitmq-plugins enable rabbitmq_federation rabbitmq_shovel"
RUNNING = "running"


def check_links(control: RabbitMQControl) -> Iterator[BrokerFinding]:
    """The shovel up and the federation down of a house's broker."""
    try:
        shovels = [row for row in control.shovels() if row.get("name") == UP]
        links = [row for row in control.federation() if row.get("exchange") == EXCHANGE]
    except BusError as error:
        yield BrokerFinding("the lines to the centre", str(error), mend=ENABLE)
        return
    yield _judged("the line up to the centre", shovels, "state", f"rabbitmqctl restart_shovel {UP}")
    again = f"rabbitmqctl restart_federation_link {links[0].get('id')}" if links else ""
    yield _judged("the line down from the centre", links, "status", again)


def _judged(what: str, rows: list[dict[str, Any]], state: str, again: str) -> BrokerFinding:
    if not rows:
        return BrokerFinding(what, "it is missing", mend=IMPORT)
    row = rows[0]
    if row.get(state) == RUNNING:
        return BrokerFinding(what, note=f"it has been running since {row.get('last_changed')}")
    return BrokerFinding(
        what,
        f"it is {row.get(state)}{_why(row)}: the centre can't be reached from here, its certificate is not valid, "
        "or it refuses this house's password",
        mend=again,
    )


def _why(row: Mapping[str, Any]) -> str:
    said = str(row.get("error") or row.get("termination_reason") or "").strip()
    return f" ({said.splitlines()[0][:120]})" if said else ""
