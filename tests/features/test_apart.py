"""Modules as processes of their own on RabbitMQ: announced, one of each, missed when they are gone, replaceable."""

import os
import signal
import sys
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

from lumen.bus import Bus, connect
from lumen.language.projects import Project
from lumen.run.presence import Peer, Presence
from tests import ROOT
from tests.copying import copied_project
from tests.guarded import DEVNULL, PIPE, STDOUT, Guarded, run_guarded
from tests.rabbitmq import RabbitMQ
from tests.waiting import HANG, Collector, until

POSTER = ROOT / "examples/modules/poster.py"
FACT = "lumen.NAO.persistence.fact"
PATIENT = f"""
import sys
from lumen.run import claiming, node
from lumen.cli.main import main
claiming.CLAIM_DURATION = node.CLAIM_DURATION = {HANG}
sys.exit(main(sys.argv[1:]))
"""
"""The command line, with time for a rival that announces itself late."""


@pytest.fixture
def bus(broker: RabbitMQ, project: Project) -> Iterator[Bus]:
    bus = connect(broker.url, project)
    yield bus
    bus.close()


@pytest.fixture
def brain(bus: Bus) -> Iterator[Presence]:
    """The presence of a brain, which watches the other parts."""
    presence = Presence(bus, "NAO", ("brain",))
    presence.settle()
    yield presence
    presence.close()


class Started:
    """Starts programs on the broker, and ends them."""

    def __init__(self, stack: ExitStack, url: str, home: Path) -> None:
        self._stack, self._environment = stack, {**os.environ, "LUMEN_BUS": url, "XDG_STATE_HOME": str(home)}

    def __call__(self, *words: str) -> Guarded[str]:
        process = Guarded(
            [sys.executable, *words],
            env=self._environment,
            text=True,
            stdin=DEVNULL,
            stdout=PIPE,
            stderr=STDOUT,
        )
        self._stack.callback(process.communicate)
        self._stack.callback(process.kill)
        return process


@pytest.fixture
def start(broker: RabbitMQ, tmp_path: Path) -> Iterator[Started]:
    with ExitStack() as stack:
        yield Started(stack, broker.url, tmp_path)


def here(presence: Presence, part: str) -> Peer:
    """Wait until that part is there, and return it."""
    until(lambda: (presence.tick(), presence.find(part))[1] is not None and presence.find(part).state == "here")  # type: ignore[union-attr]
    found = presence.find(part)
    assert found
    return found


def test_a_module_is_announced_does_its_work_is_one_and_is_missed(
    bus: Bus, brain: Presence, start: Started, tmp_path: Path
) -> None:
    copy = tmp_path / "project"
    run_guarded([sys.executable, "-m", "lumen", "new", str(copy)], check=True, capture_output=True)
    first = start("-m", "lumen", "run", str(copy), "--only", "memory")
    assert here(brain, "memory").said["process"] == first.pid
    answers = Collector()
    bus.subscribe("lumen.answers", answers)
    bus.publish("lumen.state", {"robot": "NAO", "time": 1.0, "entered": ["idle"], "context": {"visitor": "Ani"}})
    bus.publish(FACT, {"method": "list"}, reply_to="lumen.answers")
    until(lambda: _again(bus, answers))
    second = start("-c", PATIENT, "run", str(copy), "--only", "memory")
    until(lambda: (brain.tick(), second.poll())[1] is not None)
    assert second.returncode == 2
    assert second.stdout
    assert f"process {first.pid} on " in (said := second.stdout.read())
    assert "is already the memory of NAO on this bus" in said
    first.kill()
    lost: list[str] = []
    until(lambda: (lost.extend(event.name for event in brain.tick()), lost)[1])
    assert lost == ["memory.lost"]
    assert (copy / ".lumen/memory.db").exists()


def _again(bus: Bus, answers: Collector) -> bool:
    """Return whether an answer knows the visitor; if it does not yet, ask once more."""
    if not answers.bodies:
        return False
    if [visitor["name"] for visitor in answers.bodies[-1]["visitors"]] == ["Ani"]:
        return True
    answers.messages.clear()
    bus.publish(FACT, {"method": "list"}, reply_to="lumen.answers")
    return False


@pytest.mark.slow
def test_a_program_of_lumen_yaml_is_started_restarted_and_ended_by_a_process_of_its_own(
    bus: Bus, start: Started, tmp_path: Path
) -> None:
    brain = Presence(bus, "NAO", ("brain",), key="lumen.NAO.presence")
    brain.settle()
    copy = copied_project(ROOT / "examples/minimal", tmp_path / "project")
    with (copy / "lumen.yaml").open("a") as file:
        file.write("modules: {mood: {command: [python3, mood.py], health: 60s}}\n")
    program = "from lumen.bus import join\nwith join() as module:\n    print('joined as', module.name)\n"
    (copy / "mood.py").write_text(f"{program}    while module.wait(1.0): pass\n")
    host = start("-m", "lumen", "run", str(copy), "--only", "mood")
    first = here(brain, "mood").said["process"]
    assert first != host.pid
    os.kill(first, signal.SIGKILL)
    until(lambda: here(brain, "mood").said["process"] != first)
    host.terminate()
    until(lambda: (brain.tick(), brain.left("mood"))[1])
    assert host.stdout
    said = host.stdout.read()
    assert "My exhibition: mood of NAO, on " in said
    assert said.count("  joined as mood") == 2
    assert "was ended by SIGKILL" in said
    brain.close()


@pytest.mark.once
def test_a_module_of_ones_own_takes_the_place_of_one(bus: Bus, brain: Presence, start: Started) -> None:
    process, perceived = start(str(POSTER)), Collector()
    bus.subscribe("lumen.NAO.social.perception", perceived)
    here(brain, "social")
    bus.publish("lumen.NAO.social.expression", {"text": "Selamat pagi!"})
    assert perceived.wait(1) == [{"kind": "posted", "text": "Selamat pagi!"}]
    assert process.stdout
    assert process.stdout.readline() == "Selamat pagi!\n"
