"""What a broker was told beside what it should have been: pure, so that each kind of fault needs no broker."""

import copy
from collections.abc import Callable
from typing import Any

from lumen.features.fleet.broker_rights import compare
from lumen.features.fleet.brokers import ROBOTS, UP, house_settings
from lumen.features.fleet.settings import Fleet, FleetHouse
from tests.tables import for_each

FLEET = Fleet("amqps://centre.example/", houses={"itb": FleetHouse("amqps://itb.example/", ("nao1",))})
WANTED: Any = house_settings(FLEET, "itb", {ROBOTS: ""}, "").definitions
THERE: Any = house_settings(FLEET, "itb", {ROBOTS: "secret"}, "another", ca="/etc/rabbitmq/ca.pem").definitions


def test_passwords_and_files_of_the_machine_are_not_compared() -> None:
    found = list(compare(WANTED, THERE))
    assert not any(row.wrong for row in found)
    assert [row.what for row in found if "polic" in row.what] == ["all policies"]


def other_centre(there: Any) -> None:
    there["parameters"][1]["value"]["dest-uri"] = "amqps://itb:x@elsewhere.example?verify=verify_peer"


def short_queue(there: Any) -> None:
    there["queues"][0]["arguments"] = {"x-queue-type": "quorum"}


def leak(there: Any) -> None:
    there["bindings"].append({**there["bindings"][-1], "routing_key": "lumen.#"})


def lost_binding(there: Any) -> None:
    del there["bindings"][0]


def other_user(there: Any) -> None:
    there["users"][0]["name"] = "robot"


@for_each(
    ("spoil", "what", "says", "mend"),
    [
        (
            other_centre,
            f"the shovel {UP}",
            'its dest-uri is "amqps://itb@elsewhere.example", not ',
            "import_definitions",
        ),
        (
            short_queue,
            f"the queue {UP}",
            "its x-max-length is null, not 50000",
            f"rabbitmqctl delete_queue {UP}, which deletes",
        ),
        (leak, f"the binding of lumen.# from amq.topic to {UP}", "sends additional messages", "delete_queue"),
        (lost_binding, "the binding of fleet.desired.itb from lumen.fleet to amq.topic", "it is missing", "import_"),
        (other_user, "the user robots", "it is missing", "import_definitions"),
    ],
)
def test_each_fault_is_told_by_name_and_nothing_else(
    spoil: Callable[[Any], None], what: str, says: str, mend: str
) -> None:
    there = copy.deepcopy(THERE)
    spoil(there)
    (row,) = [row for row in compare(WANTED, there) if row.wrong]
    assert row.what == what
    assert says in row.wrong
    assert mend in row.mend
    assert "another" not in row.wrong
