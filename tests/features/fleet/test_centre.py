"""A centre with agents on one bus: what it stores, sends and answers, and its recovery after it was killed."""

import json
import re
from collections.abc import Callable, Iterator
from contextlib import closing
from pathlib import Path
from typing import Any

import pytest

from lumen.bus.memory import MemoryBus
from lumen.cli.main import main
from lumen.errors import UsageError
from lumen.features.fleet.agent import FleetAgent
from lumen.features.fleet.bundle import messages_of
from lumen.features.fleet.installing import BundleFolder
from lumen.features.fleet.memory import AgentMemory
from lumen.features.fleet.serving import ServedCentre, fleet_in
from lumen.features.fleet.signing import Signer, generate
from lumen.language.fleet_keys import bundle_key, desired_key, incident_key, presence_key
from lumen.project.files import fingerprint, read_files
from tests.features.fleet.houses import Taker, changed, project

PLAN = {"steps": ["demo-1", "50%", "all"], "pause": 2.0, "abort-if": "falls > 0"}


class Hall:
    """The centre and all robots of the example's fleet, each with an agent; each `look` advances the time."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.now = folder, 1_000_000.0
        generate(folder / "key")
        self.signer = Signer(folder / "key")
        self.root = project(folder / "centre", self.signer.public)
        self.bus = MemoryBus(f"fleet-{folder.name}")
        self.takers: dict[str, Taker] = {}
        self.agents: dict[str, FleetAgent] = {}
        self.falls: dict[str, int] = {}
        self.lines: list[str] = []
        for name in fleet_in(self.root).robots:
            self._robot(name)
        self.served = self.serve()

    def _robot(self, name: str) -> None:
        house, _, robot = name.partition("/")
        taker = self.takers[name] = Taker(read_files(self.root))
        agent = self.agents[name] = FleetAgent(
            house, robot, self.signer.public, taker, AgentMemory(), BundleFolder(self.folder / "kept" / house / robot),
            save=lambda _: "", tell=self.lines.append,
            incident=lambda kind, text: self.bus.publish(incident_key(house, robot), {"kind": kind, "text": text}),
        )  # fmt: skip
        self.bus.subscribe(desired_key(house), lambda message: agent.order(message.body))
        self.bus.subscribe(bundle_key(house), lambda message: agent.bundle(message.body))

    def serve(self) -> ServedCentre:
        """Start the centre from the files that it wrote, and return it."""
        served = ServedCentre(self.root, self.signer, MemoryBus(f"fleet-{self.folder.name}"), self.lines.append)
        served.centre._clock = lambda: self.now  # the time that the test makes
        self.served = served
        return served

    def look(self) -> None:
        """Advance the time by one second: agents tick, robots report, and the centre reads."""
        self.now += 1.0
        for name, agent in self.agents.items():
            agent.tick()
            if agent.state == "checking":
                self.takers[name].take(agent)
            for _, answer in self.takers[name].tried:
                answer({"verdict": "dry run", "visits": {"visits": 2, "same": 2, "differing": 0}})
            said = agent.presence(1.0, {"falls": self.falls.get(name, 0), "visits": 1, "errors": 0})
            self.bus.publish(presence_key(*name.split("/")), said.to_json() | {"clock": self.now})
        self.served.tick()

    def until(self, holds: Callable[[], object], looks: int = 100) -> None:
        for _ in range(looks):
            if holds():
                return
            self.look()
        pytest.fail(f"it never came to that: {self.status()['rollout']}; {self.lines[-5:]}")

    def ask(self, what: str, **more: Any) -> dict[str, Any]:
        return self.served._desk.answer({"ask": what, "by": "Ani", **more}, self.now)

    def status(self) -> dict[str, Any]:
        return self.ask("status")

    def publish(self, files: dict[str, bytes]) -> str:
        return [str(self.ask("publish", bundle=body)["bundle"]) for body in messages_of(files, self.signer)][-1]

    def have(self, hash: str) -> int:
        return sum(agent.running == hash for agent in self.agents.values())


@pytest.fixture
def hall(tmp_path: Path) -> Iterator[Hall]:
    found = Hall(tmp_path)
    yield found
    found.served.close()


def test_a_bundle_comes_to_all_robots_by_the_steps_of_the_rollout(hall: Hall) -> None:
    hash, most = hall.publish(changed(hall.root)), []
    hall.look()
    assert hall.ask("rollout", bundle=hash[:10], **PLAN) == {"bundle": hash}
    hall.until(lambda: most.append(hall.have(hash)) or hall.status()["rollout"]["state"] == "finished")
    assert {0, 1, 3, 6} <= {*most}
    row = hall.status()["robots"][0]
    assert (row["name"], row["house"], row["bundle"], row["state"]) == ("nao1", "itb", hash, "proved")
    assert row["since"].endswith("Z")
    assert [step["most"] for step in hall.status()["rollout"]["steps"]] == [1, 3, 6]
    assert hall.status()["proved"] == [hash]


def test_all_try_a_bundle_before_a_rollout_and_with_it(hall: Hall) -> None:
    hash = hall.publish(changed(hall.root))
    hall.ask("try", bundle=hash)
    hall.until(lambda: hall.status()["trying"] == {"bundle": hash, "same": 6, "differ": 0, "refused": 0})
    assert hall.have(hash) == 0
    assert hall.status()["robots"][0]["tried"]["played"] == 2
    hall.ask("rollout", bundle=hash, **PLAN | {"try": True})
    with pytest.raises(UsageError, match="a rollout is under way"):
        hall.ask("try", bundle=hash)
    assert not hall.status()["rollout"]["tried"]
    hall.until(lambda: hall.status()["rollout"]["tried"])
    hall.until(lambda: hall.status()["rollout"]["state"] == "finished")
    assert hall.status()["trying"] is None


def test_a_fall_sends_all_back_and_the_reason_is_told(hall: Hall) -> None:
    before = hall.agents["itb/nao1"].running
    hash = hall.publish(changed(hall.root))
    hall.look()
    hall.ask("rollout", bundle=hash, **PLAN)
    hall.until(lambda: hall.have(hash) == 3)
    hall.falls["itb/nao1"] = 1
    hall.until(lambda: hall.have(before) == 6)
    rollout = hall.status()["rollout"]
    assert rollout["state"] == "aborted"
    assert "`falls > 0` holds" in rollout["reason"]
    assert any("aborted" in line for line in hall.lines)


def test_a_centre_that_is_killed_in_the_middle_goes_on_where_it_was(hall: Hall) -> None:
    hash = hall.publish(changed(hall.root))
    hall.look()
    hall.ask("rollout", bundle=hash, **PLAN)
    hall.until(lambda: hall.have(hash) == 1)
    hall.served._home.release()
    journal = hall.served.centre._journal.file
    hall.served.centre.close()
    hall.served._desk.close()
    with journal.open("ab") as opened:
        opened.write(b'{"at": "half a li')
    version = hall.served.centre.state.version
    hall.serve()
    assert hall.served.centre.state.version == version
    assert hall.served.centre.state.rollout.assigned == ("itb/nao1",)
    hall.until(lambda: hall.have(hash) == 6)


def test_a_disk_that_is_full_lets_the_centre_decide_nothing(hall: Hall, monkeypatch: pytest.MonkeyPatch) -> None:
    hash = hall.publish(changed(hall.root))
    hall.look()
    hall.ask("rollout", bundle=hash, **PLAN)
    monkeypatch.setattr(hall.served.centre._journal, "write", lambda *_: "no space left on device")
    for _ in range(20):
        hall.look()
    assert hall.have(hash) == 0
    assert hall.status()["trouble"] == "no space left on device"
    with pytest.raises(UsageError, match="no space left"):
        hall.ask("abort")
    monkeypatch.undo()
    hall.until(lambda: hall.have(hash) == 6)


def test_a_pinned_robot_takes_no_part(hall: Hall) -> None:
    hash = hall.publish(changed(hall.root))
    hall.ask("pin", robot="window/nao1")
    hall.look()
    hall.ask("rollout", bundle=hash, **PLAN)
    hall.until(lambda: hall.status()["rollout"]["state"] == "finished")
    assert hall.have(hash) == 5
    assert next(row for row in hall.status()["robots"] if row["house"] == "window")["pinned"]
    hall.ask("unpin", robot="window/nao1")
    assert hall.served.centre.state.pinned == ()


@pytest.mark.parametrize(
    ("body", "said"),
    [
        ({"ask": "rollout", "bundle": "ff"}, "no published bundle has a hash that begins with `ff`"),
        ({"ask": "pause"}, "no rollout is under way"),
        ({"ask": "abort"}, "no rollout is under way"),
        ({"ask": "pin", "robot": "itb/nao9"}, "the fleet has no robot `itb/nao9`: did you mean"),
        ({"ask": "rollout"}, "`rollout` needs a `bundle`, such as {"),
        ({"ask": "publish", "bundle": {"hash": 7}}, "`publish` needs a `bundle` with its `hash`"),
        ({"ask": "unpin", "robot": ["NAO"]}, "`unpin` needs a `robot`, such as {"),
        ({"ask": "statsu"}, "the centre has no request `statsu`: did you mean `status`"),
        ({"ask": "publish", "bundle": {"hash": "a" * 64}}, "a message is not a valid bundle"),
        ("x", "the request has no `ask`"),
    ],
)
def test_what_can_not_be_is_answered_in_words(hall: Hall, body: Any, said: str) -> None:
    with pytest.raises((UsageError, ValueError), match=re.escape(said)):
        hall.served._desk.answer(body, 0.0)


@pytest.mark.parametrize(
    ("plan", "said"),
    [
        ({"steps": ["demo"]}, "`demo` is neither a group nor a share of the robots: did you mean `demo-1`"),
        ({"abort-if": "fals > 0"}, "--abort-if, character 1: there is no measure `fals`"),
    ],
)
def test_a_plan_that_can_not_be_is_refused_in_words(hall: Hall, plan: dict[str, Any], said: str) -> None:
    hash = hall.publish(changed(hall.root))
    with pytest.raises(UsageError) as caught:
        hall.ask("rollout", bundle=hash, **plan)
    assert said in str(caught.value)


def test_only_one_process_is_the_centre_of_a_folder_and_only_with_its_key(hall: Hall, tmp_path: Path) -> None:
    with closing(MemoryBus()) as bus:
        with pytest.raises(UsageError, match="another process is already the centre"):
            ServedCentre(hall.root, hall.signer, bus, print)
        generate(tmp_path / "other")
        with pytest.raises(UsageError, match="the private key does not match"):
            ServedCentre(hall.root, Signer(tmp_path / "other"), bus, print)


@pytest.mark.parametrize("body", [None, [], {"state": "x"}, {"bundle": 3}, {"now": {"falls": "many"}}, {"version": -1}])
def test_what_is_no_presence_changes_nothing(hall: Hall, body: Any) -> None:
    hall.bus.publish(presence_key("itb", "nao1"), body)
    hall.bus.publish(presence_key("itb", "stranger"), {"bundle": "x"})
    hall.served.tick()
    assert hall.served.centre.heard == {}


def test_nothing_but_numbers_hashes_and_words_of_ours_leaves_a_house(hall: Hall) -> None:
    said: list[str] = []
    hall.bus.subscribe("fleet.#", lambda message: said.append(f"{message.key} {json.dumps(message.body)}"))
    hash = hall.publish(changed(hall.root))
    hall.look()
    hall.ask("rollout", bundle=hash, **PLAN)
    hall.until(lambda: hall.have(hash) == 6)
    up = [line for line in said if line.startswith(("fleet.presence", "fleet.incident"))]
    assert up
    assert not any("Welcome" in line or "Nao." in line for line in up)
    assert max(map(len, up)) < 1200
    assert fingerprint(changed(hall.root)) == hash


@pytest.mark.process
def test_a_centre_without_a_broker_is_told_with_what_helps(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["fleet", "status", "--project", str(tmp_path), "--bus", "amqp://127.0.0.1:1/"]) == 2
    told = capsys.readouterr().err
    assert "no broker listens at 127.0.0.1:1: start RabbitMQ there (set the centre's broker with --bus" in told
    assert "memory" not in told
