"""Three RabbitMQ as `lumen fleet init` describes them: what crosses between them, what does not, and what waits."""

import json
import re
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
from lumen.features.fleet.broker_finding import BrokerFinding
from lumen.features.fleet.broker_links import check_links
from lumen.features.fleet.brokers import CENTRE, UP, write_settings
from lumen.features.fleet.keys import EXCHANGE, incident_key
from lumen.features.fleet.rabbitmqctl import RabbitMQControl
from tests.fleet.brokers import HOUSES, FleetBrokers
from tests.fleet.checking import checked, ctl, mended, wrong
from tests.fleet.houses import changed
from tests.fleet.museums import ROBOTS, Museums
from tests.waiting import Collector, until


@pytest.fixture(scope="module")
def own_broker(tmp_path_factory: pytest.TempPathFactory) -> Iterator[FleetBrokers]:
    found = FleetBrokers(tmp_path_factory.mktemp("fleet"), ROBOTS)
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
    buses = {name: connect(own_broker.url(name), sender=name) for name in (CENTRE, *HOUSES)}
    heard = {name: Collector() for name in buses}
    for name, bus in buses.items():
        bus.subscribe("#", heard[name])

    def keys(name: str) -> set[str]:
        return {message.key for message in heard[name].messages}

    def said() -> bool:
        buses["itb"].publish("lumen.nao1.text", {"text": "Hello Budi"})
        buses["itb"].publish("fleet.presence.itb.nao1", {"state": "proved"})
        buses[CENTRE].publish("fleet.desired.itb", {})
        buses[CENTRE].publish("fleet.bundle.museum", {})
        return keys("museum") >= {"fleet.bundle.museum"} and "fleet.desired.itb" in keys("itb")

    until(lambda: said() and "fleet.presence.itb.nao1" in keys(CENTRE), every=0.2)
    for bus in buses.values():
        bus.close()
    assert keys(CENTRE) == {"fleet.presence.itb.nao1", "fleet.desired.itb", "fleet.bundle.museum"}
    assert keys("itb") == {"fleet.presence.itb.nao1", "lumen.nao1.text", "fleet.desired.itb"}
    assert keys("museum") == {"fleet.bundle.museum"}


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

        queue = "federation: of a test"
        assert not refused(lambda c: c.basic_publish(UP, "fleet.presence.itb.nao1", b"{}"))
        assert refused(lambda c: c.basic_publish(UP, "fleet.presence.museum.nao1", b"{}"))
        assert refused(lambda c: c.basic_publish("amq.topic", "fleet.order", b"{}"))
        assert refused(lambda c: c.queue_declare("mine"))
        assert not refused(lambda c: c.queue_declare(queue, auto_delete=True))
        assert not refused(lambda c: c.queue_bind(queue, EXCHANGE, "fleet.desired.itb"))
        assert refused(lambda c: c.queue_bind(queue, EXCHANGE, "fleet.desired.museum"))
        assert refused(lambda c: c.queue_bind(queue, EXCHANGE, "#"))
        connection.channel().queue_delete(queue)


def test_a_rollout_goes_on_under_cuts_and_a_centre_that_is_killed(museums: Museums) -> None:
    museums.until(lambda: len(museums.served.centre.heard) == 5)
    hash = museums.roll(changed(museums.root))
    museums.until(lambda: museums.have(hash) == 2)
    assert museums.most == 2
    museums.brokers.cables["museum"].refuse()
    museums.served.close()
    seen = Collector()
    museums.buses["museum"].subscribe("lumen.tour", seen)
    museums.buses["museum"].publish("lumen.tour", {"goes": "on"})
    assert seen.wait(1) == [{"goes": "on"}]
    museums.serve()
    assert museums.served.centre.state.rollout.bundle == hash
    museums.until(lambda: {name.partition("/")[0] for name in museums.served.centre.heard} == {"itb"})
    museums.until(lambda: museums.served.centre.state.rollout.waited > 3.0)
    assert museums.served.centre.state.rollout.at == 0  # half of the step was not heard since
    museums.brokers.cables["museum"].mend()
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


def test_what_a_house_lacks_is_told_with_the_command_that_mends_it(
    own_broker: FleetBrokers, museums: Museums, capsys: pytest.CaptureFixture[str]
) -> None:
    """Some fifteen calls of rabbitmqctl, each half a second: it is RabbitMQ's own word that counts."""
    ctl(own_broker, "itb", "set_permissions", "robots", ".*", ".*", ".*")
    ctl(own_broker, "itb", "clear_policy", EXCHANGE)
    ctl(own_broker, "itb", "delete_shovel", UP)
    found = checked(own_broker, museums.root, "itb", capsys)
    assert wrong(found) == {
        "the permissions of the user robots": r'its configure is ".*", not "^(?!lumen\\.fleet).*"',
        f"the shovel {UP}": "it is missing",
        f"the policy {EXCHANGE}": "it is missing",
        "the line up to the centre": "it is missing",
        "the line down from the centre": "it is missing",
    }
    mended(own_broker, "itb", found)
    control = RabbitMQControl(own_broker.brokers["itb"].ctl)
    seen: list[dict[str, Any]] = []
    until(lambda: seen.append(checked(own_broker, museums.root, "itb", capsys)) or not wrong(seen[-1]), every=1.0)
    found = seen[-1]
    assert found["the broker"]["note"] == "it answers, without TLS"
    assert {"all users", "all permissions", "all bindings", "all parameters", "all policies"} <= found.keys()
    assert found["the line up to the centre"]["note"].startswith("it has been running since ")
    own_broker.cables["itb"].refuse()
    cut: list[BrokerFinding] = []
    until(
        lambda: cut.extend(check_links(control)) or all("can't be reached" in row.wrong for row in cut[-2:]), every=1.0
    )
    assert [row.mend.split()[1] for row in cut[-2:]] == ["restart_shovel", "restart_federation_link"]


def test_what_the_centre_lacks_is_told(
    own_broker: FleetBrokers,
    museums: Museums,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    found = checked(own_broker, museums.root, CENTRE, capsys)
    assert wrong(found) == {}
    assert found["the certificate"]["note"].startswith("it is valid until ")
    ctl(own_broker, CENTRE, "clear_topic_permissions", "itb", EXCHANGE)
    monkeypatch.setattr("lumen.features.fleet.broker_certificate.NOTICE", 100)
    found = checked(own_broker, museums.root, CENTRE, capsys)
    assert wrong(found).keys() == {"the certificate", f"the topic permissions of the user itb on {EXCHANGE}"}
    assert re.fullmatch(r"it expires on \d{4}-\d\d-\d\d, in \d+ days", found["the certificate"]["wrong"])
    del found["the certificate"]
    mended(own_broker, CENTRE, found)
    monkeypatch.undo()
    assert not wrong(checked(own_broker, museums.root, CENTRE, capsys))


def test_what_was_not_looked_at_is_not_well(
    own_broker: FleetBrokers, museums: Museums, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    where = ["--project", str(museums.root), "--bus", own_broker.url("itb")]
    assert main(["fleet", "check", "itb", *where, "--rabbitmqctl", "no-such-tool"]) == 1
    told = capsys.readouterr().out
    assert f"ok the queue {UP}: " in told
    assert "!! users, rights, policies and lines: they were not checked: `no-such-tool` can't be run" in told
    where = ["--project", str(museums.root), "--bus", own_broker.url(CENTRE)]
    assert main(["fleet", "check", "itb", *where, "--rabbitmqctl", "false"]) == 1
    assert f"!! the queue {UP}: it is missing\n   rabbitmqctl import_definitions" in capsys.readouterr().out
    monkeypatch.setattr("lumen.features.fleet.command.ANSWER_TIMEOUT", 0.2)
    museums.served._desk.close()
    assert main(["fleet", "status", *where]) == 2
    assert "no centre answers on 127.0.0.1" in capsys.readouterr().err


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
        told("pin", "museum/nao3")
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


def test_passwords_stay_when_the_files_are_written_again(own_broker: FleetBrokers, tmp_path: Path) -> None:
    first = {path: path.stat().st_mode & 0o077 for path in write_settings(own_broker.fleet, tmp_path)}
    assert not any(first.values())
    before = json.loads((tmp_path / CENTRE / "passwords.json").read_text())
    write_settings(own_broker.fleet, tmp_path)
    assert json.loads((tmp_path / CENTRE / "passwords.json").read_text()) == before
    definitions = (tmp_path / "itb" / "definitions.json").read_text()
    assert "verify=verify_peer" in definitions
    assert before["museum"] not in definitions
