"""Twenty recording robots in two houses on three RabbitMQ: lines are cut, centres killed, robots come and go."""

import json
import random
import sys
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

import pytest

from lumen.bus import connect
from lumen.features.fleet.bundle import messages_of
from lumen.features.fleet.installing import finish
from lumen.features.fleet.part import FleetPart
from lumen.features.fleet.rollouts.rollout import allowed
from lumen.features.fleet.serving import ServedCentre
from lumen.features.fleet.signing import Signer, generate
from lumen.project.files import fingerprint, read_files
from lumen.run.exhibition import Exhibition
from lumen.run.plan import Plan
from lumen.run.recovery.run_directory import RunDirectory
from lumen.run.recovery.startup import startup_project
from lumen.run.setup import set_up
from tests.features.fleet.brokers import CENTRE, HOUSES, FleetBrokers
from tests.features.fleet.houses import changed, project

ROBOTS = {"itb": tuple(f"nao{i}" for i in range(12)), "hall": tuple(f"nao{i}" for i in range(8))}
STEPS = [{"to": "10%"}, {"to": "50%"}, {"to": "all"}]


class RunningRobot:
    """One robot's exhibition, which can be ended and begun again."""

    def __init__(self, root: Path, url: str) -> None:
        self.root, self.url = root, url
        self.show: Exhibition | None = None

    def begin(self) -> None:
        finish(self.root)
        self.directory = RunDirectory(self.root)
        loaded = startup_project(self.root, self.directory, last_good=False)
        setup = set_up("recording", loaded, "1", None)
        show = Exhibition(
            Plan(loaded, setup, self.url, options={"directory": self.directory, "reload": "auto", "fresh": False})
        )
        self.directory.begin(loaded, read_files(self.root))
        show.start()
        self.show = show

    def end(self) -> None:
        if self.show:
            self.show.close()
            self.directory.close(forget=False)
        self.show = None

    @property
    def bundle(self) -> str:
        """The bundle that the agent runs, or an empty string if the robot has no running exhibition."""
        if self.show is None:
            return ""
        (part,) = [part for part in self.show.node.parts if isinstance(part, FleetPart)]
        return part.agent.running


class Twenty:
    """All twenty robots and a centre; `live` lets them live until a condition holds, and checks them at each moment."""

    def __init__(self, brokers: FleetBrokers, folder: Path, seed: int) -> None:
        self.brokers, self.random = brokers, random.Random(seed)
        generate(folder / "key")
        self.signer = Signer(folder / "key")
        houses = {
            name: {"broker": f"amqp://127.0.0.1:{brokers.brokers[name].port}/", "robots": [*ROBOTS[name]]}
            for name in HOUSES
        }
        fleet = {
            "key": self.signer.public,
            "houses": houses,
            "measures": {"complaints": {"event": "heard"}},
            "rollout": {"steps": STEPS, "pause": "3s", "abort-if": "complaints > 0"},
        }
        self.robots: dict[str, RunningRobot] = {}
        for house in HOUSES:
            for robot in ROBOTS[house]:
                root = project(folder / house / robot)
                settings = root / "lumen.yaml"
                settings.write_text(f"house: {house}\n" + settings.read_text().replace("name: nao1", f"name: {robot}"))
                (root / "fleet.yaml").write_text(json.dumps(fleet))
                self.robots[f"{house}/{robot}"] = RunningRobot(root, brokers.url(house))
        self.root = project(folder / "centre")
        (self.root / "fleet.yaml").write_text(json.dumps(fleet))
        self.served = self.serve()
        self.looked = self.most = 0
        self.kills = self.cuts = self.absences = 0
        for robot in self.robots.values():
            robot.begin()
        self.first = {robot.bundle for robot in self.robots.values()}

    def serve(self) -> ServedCentre:
        bus = connect(self.brokers.url(CENTRE), sender=CENTRE)
        self.served = ServedCentre(self.root, self.signer, bus, lambda _: None, self.brokers.url(CENTRE))
        return self.served

    def live(self, holds: Callable[[], object], seconds: float = 180.0, *, trouble: bool = False) -> None:
        until = time.monotonic() + seconds
        while not holds():
            assert time.monotonic() < until, f"it never came to that: {self.told()}"
            for robot in self.robots.values():
                if robot.show:
                    robot.show.tick()
            self.served.tick()
            self._look()
            if trouble and self.random.random() < 0.008:
                self._misfortune()

    def _look(self) -> None:
        """Check that no more robots than the step allows run an unproved bundle."""
        state = self.served.centre.state
        fine = {"", *self.first, *state.proved}
        unproved = sum(robot.bundle not in fine for robot in self.robots.values())
        self.looked += 1
        self.most = max(self.most, unproved)
        if rollout := state.rollout:
            assert unproved <= allowed(rollout.plan, rollout.at, self.served.centre.fleet)

    def _misfortune(self) -> None:
        match self.random.choice(("cut", "mend", "kill", "off", "on")):
            case "cut":
                cable = self.brokers.cables[self.random.choice(HOUSES)]
                self.random.choice((cable.refuse, cable.reset))()
                self.cuts += 1
            case "mend":
                self.mend()
            case "kill":
                self.served.close()
                self.serve()
                self.kills += 1
            case "off":
                self.robots[self.random.choice(list(self.robots))].end()
                self.absences += 1
            case _:
                self.all_on()

    def all_on(self) -> None:
        for robot in self.robots.values():
            if robot.show is None:
                robot.begin()

    def mend(self) -> None:
        for cable in self.brokers.cables.values():
            cable.mend()

    def calm(self) -> None:
        self.mend()
        self.all_on()

    def roll(self, files: Mapping[str, bytes]) -> str:
        desk = self.served._desk
        for body in messages_of(files, self.signer):
            desk.answer({"ask": "publish", "bundle": body}, 0.0)
        desk.answer({"ask": "rollout", "bundle": fingerprint(files), "by": "Ani"}, time.time())
        return fingerprint(files)

    def have(self, bundle: str) -> int:
        return sum(robot.bundle == bundle for robot in self.robots.values())

    def told(self) -> object:
        found = self.served.centre.overview()
        return found["rollout"], [(row["house"], row["name"], row["state"], row["trouble"]) for row in found["robots"]]

    def state(self) -> str:
        rollout = self.served.centre.state.rollout
        return rollout.state if rollout else ""

    def close(self) -> None:
        for robot in self.robots.values():
            robot.end()
        self.served.close()


@pytest.fixture
def twenty(tmp_path: Path) -> Iterator[Twenty]:
    brokers = FleetBrokers(tmp_path / "fleet")
    brokers.start()
    try:
        found = Twenty(brokers, tmp_path, 21)
        yield found
        found.close()
    finally:
        brokers.close()


@pytest.mark.soak
@pytest.mark.broker
def test_twenty_robots_take_a_change_as_safely_as_one(twenty: Twenty) -> None:
    began = time.process_time()
    twenty.live(lambda: len(twenty.served.centre.heard) == 20)
    good = twenty.roll(changed(twenty.root))
    twenty.live(lambda: twenty.have(good) >= 10, 600.0, trouble=True)
    twenty.calm()
    twenty.live(lambda: twenty.state() == "finished" and twenty.have(good) == 20, 300.0)

    disliked = twenty.roll(changed(twenty.root, new="Go away! I am Nao."))
    twenty.live(lambda: twenty.have(disliked) == 10, 300.0)
    one = next(robot for robot in twenty.robots.values() if robot.bundle == disliked)
    assert one.show
    one.show.send("heard", {"result": "I want to complain"})
    twenty.live(lambda: twenty.state() == "aborted", 120.0)
    assert "`complaints > 0` holds" in twenty.served.centre.state.rollout.reason
    twenty.live(lambda: twenty.have(good) == 20, 300.0, trouble=False)

    broken = twenty.roll(changed(twenty.root, old="target: goodbye", new="target: godbye"))
    twenty.live(lambda: twenty.state() == "aborted", 120.0)
    assert "unknown-state" in twenty.served.centre.state.rollout.reason
    assert twenty.have(broken) == 0
    assert twenty.have(good) == 20
    told = (
        f"20 robots, 3 brokers: looked {twenty.looked} times, at most {twenty.most} on an unproved bundle;"
        f" {twenty.cuts} cuts, {twenty.kills} centres killed, {twenty.absences} absences;"
        f" {time.process_time() - began:.0f} s of CPU time\n"
    )
    sys.stdout.write(told)
