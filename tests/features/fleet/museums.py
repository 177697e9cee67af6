"""Agents in two houses, each on its house's broker, and a centre on its own."""

import json
import time
from collections.abc import Callable
from pathlib import Path

from lumen.bus import connect
from lumen.features.fleet.agent import FleetAgent
from lumen.features.fleet.bundle import messages_of
from lumen.features.fleet.installing import BundleFolder
from lumen.features.fleet.memory import AgentMemory
from lumen.features.fleet.serving import ServedCentre
from lumen.features.fleet.signing import Signer, generate
from lumen.language.fleet_keys import bundle_key, desired_key, presence_key
from lumen.project.files import read_files
from tests.features.fleet.brokers import CENTRE, HOUSES, FleetBrokers
from tests.features.fleet.houses import Taker, project
from tests.waiting import HANG, until

ROBOTS = {"itb": ("nao1", "nao2"), "hall": ("nao1", "nao2", "nao3")}


class Museums:
    """Agents in two houses, each on its house's broker, and a centre on its own."""

    def __init__(self, brokers: FleetBrokers, folder: Path) -> None:
        self.brokers, self.folder = brokers, folder
        generate(folder / "key")
        self.signer = Signer(folder / "key")
        self.root = project(folder / "centre")
        fleet = {
            "key": self.signer.public,
            "centre": {"broker": f"amqps://localhost:{brokers.brokers[CENTRE].secure}/"},
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
        self.served = ServedCentre(self.root, self.signer, bus, lambda _: None, self.brokers.url(CENTRE))
        return self.served

    def kill(self) -> None:
        """End the centre as a power cut would, without writing what it writes when it is closed."""
        served = self.served
        served._desk.close()
        if served._stream:
            served._stream.close()
        for undo in served.centre._undo:
            undo()
        served._bus.close()
        served._home.release()

    def look(self) -> None:
        for name, agent in self.agents.items():
            agent.tick()
            if agent.state == "checking":
                self.takers[name].take(agent)
            house, _, robot = name.partition("/")
            self.buses[house].publish(presence_key(house, robot), agent.presence(0.1, {}).to_json(), ttl=60.0)
        self.served.tick()
        self.most = max(self.most, len(self.served.centre.state.exposed))

    def until(self, holds: Callable[[], object], timeout: float = HANG) -> None:
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
