"""A small project of a fleet, keys, and the messages of a centre."""

import json
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from lumen.features.fleet.agent import FleetAgent
from lumen.features.fleet.bundle import messages_of
from lumen.features.fleet.installing import BundleFolder
from lumen.features.fleet.memory import AgentMemory
from lumen.features.fleet.rollouts.orders import DesiredState
from lumen.features.fleet.signing import ORDER, Signer
from lumen.project.files import fingerprint, read_files
from tests import ROOT
from tests.copying import copied_project

EXAMPLE = ROOT / "examples/fleet"
HOUSE, ROBOT = "itb", "nao1"


def project(folder: Path, key: str = "") -> Path:
    """Copy the example's project, which then trusts that key; return the copy."""
    copied_project(EXAMPLE, folder)
    if key:
        file = folder / "fleet.yaml"
        file.write_text(f"key: {key}\n{file.read_text()}")
    return folder


def changed(root: Path, old: str = "Hello! I am Nao.", new: str = "Welcome! I am Nao.") -> dict[str, bytes]:
    """Return the files of a project with another sentence."""
    files = dict(read_files(root))
    text = files["behaviors/hello.yaml"].decode()
    assert old in text
    return {**files, "behaviors/hello.yaml": text.replace(old, new).encode()}


def ordered(
    signer: Signer,
    wanted: str,
    version: int = 1,
    *,
    centre: str = "one",
    term: int = 1,
    house: str = HOUSE,
    trying: str = "",
) -> dict[str, str]:
    """Return an order with its signature."""
    text = DesiredState(centre, term, version, house, {ROBOT: wanted} if wanted else {}, trying).text()
    return {"order": text, "signature": signer.sign(ORDER, text.encode())}


class Taker:
    """A stand-in for an exhibition's reload; it applies offered files when the test calls `take`."""

    def __init__(self, files: Mapping[str, bytes]) -> None:
        self.known = {fingerprint(files): dict(files)}
        self.running, self.on_probation = fingerprint(files), False
        self.offered: list[tuple[dict[str, bytes], Callable[[Any], None]]] = []
        self.tried: list[tuple[dict[str, bytes], Callable[[Any], None]]] = []
        self.installed: list[str] = []
        self.unwritten = ""

    def files(self, hash: str) -> Mapping[str, bytes] | None:
        return self.known.get(hash)

    def offer(self, files: Mapping[str, bytes], answer: Callable[[Any], None]) -> None:
        self.known[fingerprint(files)] = dict(files)
        self.offered.append((dict(files), answer))

    def attempt(self, files: Mapping[str, bytes], answer: Callable[[Any], None]) -> None:
        self.tried.append((dict(files), answer))

    def install(self, files: Mapping[str, bytes]) -> None:
        self.installed.append(fingerprint(files))

    def take(self, agent: FleetAgent) -> None:
        """Apply the files that were offered last, and let them prove themselves."""
        files, answer = self.offered[-1]
        before, self.running, self.on_probation = self.running, fingerprint(files), True
        answer({"verdict": "applied", "before": before, "visits": {"visits": 9, "same": 7}})
        agent.tick()
        self.on_probation = False
        agent.tick()


class House:
    """An agent with a fake exhibition, and a centre's key."""

    def __init__(self, folder: Path, signer: Signer) -> None:
        self.signer, self.folder = signer, folder
        self.root = project(folder / "project", signer.public)
        self.taker = Taker(read_files(self.root))
        self.told: list[str] = []
        self.incidents: list[tuple[str, str]] = []
        self.memory = AgentMemory()
        self.saved: list[str] = []
        self.agent = self.begin()

    def begin(self) -> FleetAgent:
        """Make the agent anew, as after a start, and return it."""
        self.agent = FleetAgent(
            HOUSE, ROBOT, self.signer.public, self.taker, self.memory, BundleFolder(self.folder / "kept"),
            save=lambda memory: self.saved.append(json.dumps(memory.order)) or "", tell=self.told.append,
            incident=lambda kind, text: self.incidents.append((kind, text)),
        )  # fmt: skip
        return self.agent

    def send(self, files: Mapping[str, bytes], version: int = 1) -> str:
        """Order these files and send them; return their hash."""
        self.agent.order(ordered(self.signer, fingerprint(files), version))
        self.agent.tick()
        for body in messages_of(files, self.signer):
            self.agent.bundle(body)
        self.agent.tick()
        return fingerprint(files)
