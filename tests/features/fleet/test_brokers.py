"""Three RabbitMQ, set up as docs/fleet-brokers.md describes: which messages cross between them, and which wait."""

import json
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pika
import pytest
from pika.exceptions import ChannelClosedByBroker

from lumen.bus import connect
from lumen.cli.main import main
from lumen.features.fleet.serving import ServedCentre
from lumen.language.fleet_keys import incident_key
from tests.features.fleet.brokers import CENTRE, DOWN, HOUSES, UP, FleetBrokers, blocks
from tests.features.fleet.houses import changed
from tests.features.fleet.museums import Museums
from tests.waiting import Collector, until


@pytest.fixture(scope="module")
def own_broker(tmp_path_factory: pytest.TempPathFactory) -> Iterator[FleetBrokers]:
    found = FleetBrokers(tmp_path_factory.mktemp("fleet"))
    found.start()
    yield found
    found.close()


@pytest.fixture
def museums(own_broker: FleetBrokers, tmp_path: Path) -> Iterator[Museums]:
    found = Museums(own_broker, tmp_path)
    yield found
    for cable in own_broker.cables.values():
        cable.mend()
    found.close()


def test_what_is_of_the_fleet_crosses_and_nothing_else(own_broker: FleetBrokers) -> None:
    buses = {name: connect(own_broker.url(name), sender=f"crossing {name}") for name in (CENTRE, *HOUSES)}
    heard = {name: Collector() for name in buses}
    for name, bus in buses.items():
        bus.subscribe("#", heard[name])

    def keys(name: str) -> set[str]:
        """Return the keys of what this test sends: what earlier tests sent may still cross."""
        return {message.key for message in heard[name].messages if message.sender.startswith("crossing ")}

    def said() -> bool:
        buses["itb"].publish("lumen.nao1.text", {"text": "Hello Budi"})
        buses["itb"].publish("fleet.presence.itb.nao1", {"state": "proved"})
        buses[CENTRE].publish("fleet.desired.itb", {})
        buses[CENTRE].publish("fleet.bundle.hall", {})
        return keys("hall") >= {"fleet.bundle.hall"} and "fleet.desired.itb" in keys("itb")

    until(lambda: said() and "fleet.presence.itb.nao1" in keys(CENTRE), every=0.2)
    for bus in buses.values():
        bus.close()
    assert keys(CENTRE) == {"fleet.presence.itb.nao1", "fleet.desired.itb", "fleet.bundle.hall"}
    assert keys("itb") == {"fleet.presence.itb.nao1", "lumen.nao1.text", "fleet.desired.itb"}
    assert keys("hall") == {"fleet.bundle.hall"}


def test_a_house_can_speak_and_listen_at_the_centre_only_for_itself(own_broker: FleetBrokers) -> None:
    url = own_broker.url(CENTRE, "itb")
    with pika.BlockingConnection(pika.URLParameters(url)) as connection:

        def refused(deed: Callable[[pika.adapters.blocking_connection.BlockingChannel], object]) -> bool:
            channel = connection.channel()
            channel.confirm_delivery()
            try:
                deed(channel)
            except ChannelClosedByBroker as error:
                return bool(error.reply_code == 403)
            channel.close()
            return False

        queue, other = (f"federation: {DOWN} -> {house} A" for house in HOUSES)
        assert not refused(lambda c: c.basic_publish(UP, "fleet.presence.itb.nao1", b"{}"))
        assert refused(lambda c: c.basic_publish(UP, "fleet.presence.hall.nao1", b"{}"))
        assert refused(lambda c: c.basic_publish("amq.topic", "fleet.order", b"{}"))
        assert refused(lambda c: c.queue_declare("mine"))
        assert not refused(lambda c: c.queue_declare(queue, auto_delete=True))
        assert not refused(lambda c: c.queue_bind(queue, DOWN, "fleet.desired.itb"))
        assert refused(lambda c: c.queue_bind(queue, DOWN, "fleet.desired.hall"))
        assert refused(lambda c: c.queue_bind(queue, DOWN, "#"))
        assert refused(lambda c: c.queue_declare(other, auto_delete=True))
        assert refused(lambda c: c.basic_get(other.removesuffix(" A")))
        assert refused(lambda c: c.queue_purge(other.removesuffix(" A")))
        connection.channel().queue_delete(queue)


def test_a_rollout_goes_on_under_cuts_and_a_centre_that_is_killed(museums: Museums) -> None:
    museums.until(lambda: len(museums.served.centre.heard) == 5)
    hash = museums.roll(changed(museums.root))
    museums.until(lambda: museums.have(hash) == 2)
    assert museums.most == 2
    museums.brokers.cables["hall"].refuse()
    museums.served.close()
    seen = Collector()
    museums.buses["hall"].subscribe("lumen.tour", seen)
    museums.buses["hall"].publish("lumen.tour", {"goes": "on"})
    assert seen.wait(1) == [{"goes": "on"}]
    museums.serve()
    assert museums.served.centre.state.rollout.bundle == hash
    museums.until(lambda: {name.partition("/")[0] for name in museums.served.centre.heard} == {"itb"})
    museums.until(lambda: museums.served.centre.state.rollout.waited > 3.0)
    assert museums.served.centre.state.rollout.at == 0  # half of the step was not heard since
    museums.brokers.cables["hall"].mend()
    museums.until(lambda: museums.have(hash) == 5 and museums.served.centre.state.rollout.state == "finished")


def test_all_go_back_also_over_a_line_that_was_cut(museums: Museums) -> None:
    before = museums.agents["itb/nao1"].running
    museums.until(lambda: len(museums.served.centre.heard) == 5)
    hash = museums.roll(changed(museums.root))
    museums.until(lambda: museums.have(hash) == 2)
    for cable in museums.brokers.cables.values():
        cable.refuse()
    museums.served._desk.answer({"ask": "abort", "by": "Ani"}, time.time())
    museums.look()
    assert museums.have(hash) == 2
    assert len(museums.served.centre.state.exposed) == 2
    for cable in museums.brokers.cables.values():
        cable.mend()
    museums.until(lambda: museums.have(before) == 5 and not museums.served.centre.state.exposed)


def test_what_happened_while_no_centre_ran_is_counted_once(museums: Museums) -> None:
    """The centre is killed before it has saved anything, and the house loses its power while the line is cut."""

    def happens(text: str, id: str = "") -> None:
        url = museums.brokers.url("itb")
        with pika.BlockingConnection(pika.URLParameters(url)) as connection:
            body = json.dumps({"kind": "fell", "text": text}).encode()
            properties = pika.BasicProperties(message_id=id or text, timestamp=1_800_000_000)
            (channel := connection.channel()).confirm_delivery()
            channel.basic_publish("amq.topic", incident_key("itb", "nao1"), body, properties)

    def told() -> list[str]:
        return [row["text"] for row in museums.served.centre.log.incidents]

    happens("before")
    museums.until(lambda: told() == ["before"])
    museums.kill()
    happens("meanwhile")
    happens("meanwhile, sent anew", "meanwhile")
    museums.serve()
    museums.until(lambda: told() == ["before", "meanwhile"])
    museums.served.close()
    cable, house = museums.brokers.cables["itb"], museums.brokers.brokers["itb"]
    cable.refuse()
    happens("in the dark")
    museums.buses["itb"].close()
    house.kill()
    house.start()
    cable.mend()
    museums.buses["itb"] = connect(museums.brokers.url("itb"), sender="itb")
    museums.serve()
    museums.until(lambda: told() == ["before", "meanwhile", "in the dark"])
    assert museums.served.centre.log.kinds == {"fell": 3}
    assert museums.served.centre.log.incidents[-1]["at"] == 1_800_000_000


def test_a_second_import_repairs_the_broker_of_a_house(own_broker: FleetBrokers) -> None:
    status = "rabbitmqctl shovel_status --formatter json; rabbitmqctl federation_status --formatter json"

    def running() -> int:
        return own_broker.follow("itb", status).count('"running"')

    own_broker.follow("itb", f"rabbitmqctl clear_policy {DOWN}; rabbitmqctl delete_shovel {UP}")
    until(lambda: running() == 0, every=1.0)
    own_broker.follow("itb", "rabbitmqctl import_definitions /etc/rabbitmq/house.json")
    until(lambda: running() == 2, every=1.0)


def test_a_house_checks_the_certificate_of_the_centre() -> None:
    _, house = blocks("json")
    links = [row["value"] for row in json.loads(house)["parameters"]]
    assert [link.get("uri") or link["dest-uri"] for link in links] == [
        "amqps://itb:PASSWORD@centre.museum.example"
        "?verify=verify_peer&server_name_indication=centre.museum.example&cacertfile=/etc/rabbitmq/centre-ca.pem"
    ] * 2


def test_a_missing_centre_is_reported(
    own_broker: FleetBrokers, museums: Museums, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("lumen.features.fleet.command.ANSWER_TIMEOUT", 0.2)
    museums.served._desk.close()
    assert main(["fleet", "status", "--project", str(museums.root), "--bus", own_broker.url(CENTRE)]) == 2
    assert "no centre answers on 127.0.0.1" in capsys.readouterr().err


def test_a_centre_reports_a_broker_without_the_stream(museums: Museums) -> None:
    museums.served.close()
    bus, url = connect(museums.brokers.url("itb"), sender=CENTRE), museums.brokers.url("itb")
    told: list[str] = []
    museums.served = ServedCentre(museums.root, museums.signer, bus, told.append, url)
    assert told == [
        "the broker has no stream lumen.fleet.log: incidents are lost while no centre is running;"
        " docs/fleet-brokers.md shows how to create it"
    ]


def test_the_commands_publish_roll_out_tell_and_abort(
    museums: Museums, own_broker: FleetBrokers, capsys: pytest.CaptureFixture[str]
) -> None:
    ending = threading.Event()

    def live() -> None:
        while not ending.wait(0.05):
            museums.served._desk.tick(time.time())
            museums.look()

    thread = threading.Thread(target=live)
    thread.start()
    where = ["--project", str(museums.root), "--bus", own_broker.url(CENTRE)]

    def told(*words: str) -> Any:
        assert main(["fleet", *words, *where, "--format", "json"]) == 0
        return json.loads(capsys.readouterr().out)

    try:
        key = ["--key", str(museums.folder / "key")]
        first = told("publish", *key)["bundle"]
        behavior = museums.root / "behaviors/hello.yaml"
        behavior.write_bytes(changed(museums.root)["behaviors/hello.yaml"])
        hash = told("publish", *key)["bundle"]
        assert hash != first
        found = told("diff", hash, "--against", first)
        assert any("greeting" in change or "text" in change for change in found["changes"])
        told("pin", "hall/nao3")
        told("rollout", hash, "--first", "40%", "--then", "all", "--pause", "1h", "--abort-if", "")
        until(lambda: museums.have(hash) == 2)
        until(lambda: [row["state"] for row in told("status")["robots"]] == ["proved"] * 5)
        status = told("status")
        assert {"houses", "robots", "rollout"} <= status.keys()
        assert status["rollout"]["state"] == "going"
        assert main(["fleet", "status", *where]) == 0
        assert "-> 40%: at most 2 robots" in capsys.readouterr().out
        assert told("log").keys() == {"incidents", "kinds", "numbers"}
        assert main(["fleet", "rollout", hash, *where]) == 2
        assert "is going: abort it, or wait until it ends" in capsys.readouterr().err
        told("abort")
        until(lambda: museums.have(hash) == 0)
        behavior.write_text("states: {")
        assert main(["fleet", "publish", *key, *where]) == 2
        assert "has errors: behaviors/hello.yaml" in capsys.readouterr().err
    finally:
        ending.set()
        thread.join()
