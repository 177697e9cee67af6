"""Three RabbitMQ as `lumen fleet init` describes them: what crosses between them, what does not, and what waits."""

import json
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pika
import pytest
from pika.exceptions import ChannelClosedByBroker

from lumen.app.fleet.agent import FleetAgent
from lumen.app.fleet.brokers import CENTRE, UP, write_settings
from lumen.app.fleet.bundle import messages_of
from lumen.app.fleet.kept_bundles import BundleFolder
from lumen.app.fleet.keys import EXCHANGE, bundle_key, desired_key, presence_key
from lumen.app.fleet.memory import AgentMemory
from lumen.app.fleet.serving import ServedCentre
from lumen.app.fleet.signing import Signer, generate
from lumen.bus import connect
from lumen.cli.main import main
from lumen.loading.files import read_files
from tests.fleet.brokers import HOUSES, FleetBrokers
from tests.fleet.houses import Taker, changed, project
from tests.waiting import Collector, until

ROBOTS = {"itb": ("nao1", "nao2"), "museum": ("nao1", "nao2", "nao3")}


@pytest.fixture(scope="module")
def own_broker(tmp_path_factory: pytest.TempPathFactory) -> Iterator[FleetBrokers]:
    found = FleetBrokers(tmp_path_factory.mktemp("fleet"), ROBOTS)
    found.start()
    yield found
    found.close()


class Museums:
    """Agents in two houses, each on its house's broker, and a centre on its own."""

    def __init__(self, brokers: FleetBrokers, folder: Path) -> None:
        self.brokers, self.folder = brokers, folder
        generate(folder / "key")
        self.signer = Signer(folder / "key")
        self.root = project(folder / "centre")
        fleet = {
            "key": self.signer.public,
            "centre": {"broker": brokers.fleet.centre},
            "houses": {
                name: {"broker": f"amqp://127.0.0.1:{brokers.brokers[name].port}/", "robots": [*ROBOTS[name]]}
                for name in HOUSES
            },
            "rollout": {"steps": [{"to": "40%"}, {"to": "all"}], "pause": "2s"},
        }
        (self.root / "fleet.yaml").write_text(json.dumps(fleet))
        self.buses = {name: connect(brokers.url(name), sender=name) for name in HOUSES}
        self.agents: dict[str, FleetAgent] = {}
        self.takers: dict[str, Taker] = {}
        for house in HOUSES:
            for robot in ROBOTS[house]:
                self._robot(house, robot)
        self.served = self.serve()
        self.most = 0

    def _robot(self, house: str, robot: str) -> None:
        name, bus = f"{house}/{robot}", self.buses[house]
        taker = self.takers[name] = Taker(read_files(self.root))
        agent = self.agents[name] = FleetAgent(
            house, robot, self.signer.public, taker, AgentMemory(), BundleFolder(self.folder / house / robot),
            save=lambda _: "", tell=lambda _: None,
        )  # fmt: skip
        bus.subscribe(desired_key(house), lambda message: agent.order(message.body))
        bus.subscribe(bundle_key(house), lambda message: agent.bundle(message.body))

    def serve(self) -> ServedCentre:
        bus = connect(self.brokers.url(CENTRE), sender=CENTRE)
        self.served = ServedCentre(self.root, self.signer, bus, lambda _: None)
        return self.served

    def look(self) -> None:
        for name, agent in self.agents.items():
            agent.tick()
            if agent.state == "checking":
                self.takers[name].take(agent)
            house, _, robot = name.partition("/")
            self.buses[house].publish(presence_key(house, robot), agent.presence(0.1, {}).to_json(), ttl=60.0)
        self.served.tick()
        self.most = max(self.most, len(self.served.centre.state.exposed))

    def until(self, holds: Callable[[], object], timeout: float = 60.0) -> None:
        until(lambda: self.look() or holds(), timeout, every=0.1)

    def roll(self, files: dict[str, bytes]) -> str:
        desk = self.served._desk
        for body in messages_of(files, self.signer):
            hash = str(desk.answer({"ask": "publish", "bundle": body}, 0.0)["bundle"])
        desk.answer({"ask": "rollout", "bundle": hash, "by": "Ani"}, time.time())
        return hash

    def have(self, hash: str) -> int:
        return sum(agent.running == hash for agent in self.agents.values())

    def close(self) -> None:
        self.served.close()
        for bus in self.buses.values():
            bus.close()


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

    until(lambda: said() and "fleet.presence.itb.nao1" in keys(CENTRE), 60.0, every=0.2)
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


def test_the_command_says_what_a_broker_has_and_lacks(
    own_broker: FleetBrokers, museums: Museums, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    root = str(museums.root)
    assert main(["fleet", "check", "itb", "--project", root, "--bus", own_broker.url("itb")]) == 0
    assert main(["fleet", "check", "--project", root, "--bus", own_broker.url(CENTRE)]) == 0
    told = capsys.readouterr().out
    assert "ok the broker: it answers, in clear" in told
    assert f"ok the queue {UP}" in told
    assert main(["fleet", "check", "itb", "--project", root, "--bus", own_broker.url(CENTRE)]) == 1
    assert f"!! the queue {UP}: it is not there: import the definitions" in capsys.readouterr().out
    monkeypatch.setattr("lumen.cli.fleet.ANSWER_TIMEOUT", 0.2)
    museums.served._desk.close()
    assert main(["fleet", "status", "--project", root, "--bus", own_broker.url(CENTRE)]) == 2
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
        until(lambda: museums.have(hash) == 2, 60.0)
        until(lambda: [row["state"] for row in told("status")["robots"]] == ["proved"] * 5, 60.0)
        status = told("status")
        assert {"houses", "robots", "rollout"} <= status.keys()
        assert status["rollout"]["state"] == "going"
        assert main(["fleet", "status", *where]) == 0
        assert "-> 40%: at most 2 robots" in capsys.readouterr().out
        assert main(["fleet", "rollout", hash, *where]) == 2
        assert "is going: abort it, or let it end" in capsys.readouterr().err
        told("abort")
        until(lambda: museums.have(hash) == 0, 60.0)
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
