"""The modules in examples/modules/ run as they stand, against a real broker."""

import os
import shutil
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from lumen.bus import Bus, connect
from tests import ROOT
from tests.exhibits import project
from tests.fetched import fetched
from tests.guarded import PIPE, STDOUT, Guarded
from tests.rabbitmq import RabbitMQ
from tests.waiting import HANG, Collector

MODULES = ROOT / "examples/modules"


@contextmanager
def running(*command: str, url: str) -> Iterator[Guarded[str]]:
    environment = {**os.environ, "LUMEN_BUS": url}
    process = Guarded(command, env=environment, text=True, stdin=PIPE, stdout=PIPE, stderr=STDOUT)
    try:
        yield process
    finally:
        process.kill()
        process.communicate()


def program(name: str, folder: Path) -> tuple[str, ...]:
    """Return the command that runs a module; one in JavaScript finds its packages in `folder`."""
    if name.endswith(".py"):
        return sys.executable, str(MODULES / name)
    shutil.copy(MODULES / name, folder)
    (folder / "node_modules").symlink_to(fetched("node_modules"))
    return "node", str(folder / name)


@pytest.fixture
def bus(broker: RabbitMQ) -> Iterator[Bus]:
    """A bus that checks bodies, as an exhibition's does."""
    bus = connect(broker.url, project())
    yield bus
    bus.close()


def test_the_greeter_greets_once_for_each_who_comes_near(broker: RabbitMQ, bus: Bus, tmp_path: Path) -> None:
    commands, far, near = Collector(), {"leftSensor": 2.0, "rightSensor": 2.0}, {"leftSensor": 0.5, "rightSensor": 2.0}
    bus.subscribe("avatar.NAO.command", commands)
    with running(*program("greeter.py", tmp_path), url=broker.url) as process:
        assert process.stdout
        assert process.stdout.readline() == "listening\n"
        for body in (far, near, near, far, near):
            bus.publish("avatar.NAO.data.sonar", body)
        commands.wait(2)
    assert [c["parameter"]["text"] for c in commands.bodies] == ["Hello there!"] * 2
    assert all(message.reply_to for message in commands.messages)


def test_the_listener_in_javascript_says_and_hears(broker: RabbitMQ, bus: Bus, tmp_path: Path) -> None:
    heard = Collector()
    bus.subscribe("lumen.audio.speech.recognition", heard)
    with running(*program("listener.mjs", tmp_path), url=broker.url) as process:
        assert process.stdin
        assert process.stdout
        assert process.stdout.readline() == "listening\n"
        process.stdin.write("what can you do\n")
        process.stdin.flush()
        assert heard.wait(1)[0]["result"] == "what can you do"
        bus.publish("lumen.audio.text.stream", {"name": "Lumen", "text": "I can dance.", "date": "x"})
        assert process.stdout.readline() == "Lumen: I can dance.\n"


@pytest.mark.parametrize("name", ["greeter.py", "poster.py", "listener.mjs"])
def test_a_wrong_password_is_one_line(broker: RabbitMQ, tmp_path: Path, name: str) -> None:
    wrong = f"amqp://guest:wrong@{broker.place()}"
    with running(*program(name, tmp_path), url=wrong) as process:
        said, _ = process.communicate(timeout=HANG)
    assert process.returncode == 1
    assert said.startswith(f"{name.partition('.')[0]}: the broker")
    assert said.count("\n") == 1
    assert "wrong" not in said


@pytest.mark.parametrize("name", ["greeter.py", "listener.mjs"])
def test_a_module_is_twenty_lines(name: str) -> None:
    code = (MODULES / name).read_text().split('"""')[-1]
    lines = [line for line in code.splitlines() if line.strip() and not line.startswith("//")]
    assert len(lines) <= 20
