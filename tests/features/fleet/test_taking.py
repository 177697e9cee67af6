"""A running exhibition switches to a bundle between two visits and writes it to its folder once proved."""

import json
from pathlib import Path

import pytest

from lumen.bus.memory import MemoryBus
from lumen.features.fleet.bundle import messages_of
from lumen.features.fleet.memory import memory_file
from lumen.features.fleet.signing import Signer, generate
from lumen.project import load
from lumen.project.files import fingerprint, read_files
from lumen.project.home import home_of
from lumen.run.exhibition import Exhibition
from lumen.run.plan import Plan
from lumen.run.recovery.run_directory import RunDirectory
from lumen.run.setup import set_up
from tests.features.fleet.houses import ROBOT, changed, ordered, project
from tests.waiting import Collector, until


@pytest.mark.process
def test_it_is_taken_between_two_visits_proved_and_in_the_folder_then(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("LUMEN_HOUSE", "itb")
    key = tmp_path / "key"
    generate(key)
    signer = Signer(key)
    root = project(tmp_path / "house", signer.public)
    hello = root / "behaviors/hello.yaml"
    hello.write_text(hello.read_text("utf-8").replace("after: {30s: waiting}", "after: {1000h: waiting}"), "utf-8")
    files = changed(root)
    loaded, bus, heard, numbers = load(root), MemoryBus(str(tmp_path)), Collector(), Collector()
    bus.subscribe("fleet.numbers.itb.nao1", numbers)
    bus.subscribe("fleet.presence.itb.nao1", heard)
    directory = RunDirectory(root)
    setup = set_up("recording", loaded, "max", None)
    show = Exhibition(Plan(loaded, setup, MemoryBus(str(tmp_path)), options={"directory": directory, "reload": "auto"}))
    directory.begin(loaded, read_files(root))
    try:
        show.start()
        bus.publish("fleet.desired.itb", ordered(signer, "", trying=fingerprint(files)))
        until(lambda: show.tick() and heard.bodies[-1]["wants"], every=0.0)
        bus.publish("fleet.bundle.itb", messages_of(files, signer)[0])
        until(lambda: show.tick() and heard.bodies[-1]["tried"], every=0.0)
        assert heard.bodies[-1]["tried"]["verdict"] == "same"
        assert show.project.hash == loaded.hash
        show.send("face", {"x": 160, "y": 120})
        until(lambda: show.tick() and "greeting" in show.configuration, every=0.0)
        bus.publish("fleet.desired.itb", ordered(signer, fingerprint(files), 2))
        until(lambda: show.tick() and heard.bodies[-1]["state"] == "waiting", every=0.0)
        assert "greeting" in show.configuration
        assert show.project.hash == loaded.hash
        show.send("heard", {"result": "goodbye", "language": "en"})
        until(lambda: show.tick() and heard.bodies[-1]["state"] == "probation", every=0.0)
        assert "waiting" in show.configuration
        until(lambda: show.tick() and heard.bodies[-1]["state"] == "proved", every=0.0)
        assert heard.bodies[-1]["bundle"] == fingerprint(files)
        (ended,) = numbers.bodies
        assert ended["bundle"] == loaded.hash
        assert ended["counts"].keys() >= {"hours"}
        until(lambda: b"Welcome" in (root / "behaviors/hello.yaml").read_bytes())
        until(lambda: not json.loads((home_of(root) / memory_file(ROBOT)).read_text())["writing"])
        assert load(root).hash == show.project.hash
    finally:
        show.close()
        directory.close(forget=True)
