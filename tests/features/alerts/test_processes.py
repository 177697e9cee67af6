"""Alerts that real processes deliver: `lumen run`, and `lumen run --only` on RabbitMQ."""

import os
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path

import pytest

from lumen.bus import connect
from tests.features.alerts.halls import files
from tests.features.alerts.servers import Web
from tests.guarded import DEVNULL, Guarded
from tests.rabbitmq import RabbitMQ
from tests.waiting import Collector, until


@pytest.fixture
def hall(tmp_path: Path, web: Callable[..., Web]) -> tuple[Path, Web]:
    here = web()
    return files(tmp_path, here), here


@pytest.fixture
def start() -> Iterator[Callable[..., Guarded[str]]]:
    with ExitStack() as stack:

        def begin(folder: Path, *words: str, url: str = "") -> Guarded[str]:
            process = Guarded(
                [sys.executable, "-m", "lumen", "run", folder, "--robot", "recording", *words],
                env={**os.environ, **({"LUMEN_BUS": url} if url else {})},
                text=True,
                stdin=DEVNULL,
                stdout=DEVNULL,
                stderr=DEVNULL,
            )
            stack.callback(process.wait)
            stack.callback(process.kill)
            return process

        yield begin


@pytest.mark.slow
def test_an_exhibition_that_is_stopped_killed_and_begun_again(
    hall: tuple[Path, Web], start: Callable[..., Guarded[str]]
) -> None:
    folder, web = hall
    first = start(folder)
    until(lambda: (folder / ".lumen/snapshot.json").exists())
    first.send_signal(signal.SIGINT)
    until(lambda: web.of("stopped"))
    first.kill()
    first.wait()
    second = start(folder)
    until(lambda: web.of("crashed"))
    second.send_signal(signal.SIGTERM)
    second.wait()
    assert {body["text"].partition(": ")[2].partition(" after")[0] for body in web.bodies} == {
        "a person stopped it",
        "it ended unexpectedly, and continues",
    }


@pytest.mark.slow
@pytest.mark.broker
def test_a_brain_that_is_killed(hall: tuple[Path, Web], start: Callable[..., Guarded[str]], broker: RabbitMQ) -> None:
    folder, web = hall
    said, bus = Collector(), connect(broker.url)
    bus.subscribe("lumen.presence", said)
    start(folder, "--only", "robot", url=broker.url)
    brain = start(folder, "--only", "brain", url=broker.url)
    until(lambda: any(body.get("follows") for body in said.bodies))
    bus.close()
    brain.kill()
    until(lambda: web.of("lost"))
    assert web.of("lost")[0]["text"].endswith("the brain no longer responds, and the robot rests")
    assert [body["parts"] for body in web.bodies] == [["robot"]]
