"""Each way to start: parts in order, observers of steps, subscribed keys, threads, and the services of each part.

Real time, a broker and the simulation are in it. Each node is looked at after a few ticks, when all its parts that can
begin have begun. Threads are those that were started until then; timers are left out, for how many there are depends on
the machine.
"""

import json
import sys
import tempfile
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

from tests import ROOT
from tests.golden.exhibitions import broker, small
from tests.golden.tables import written
from tests.golden.warm import Warm
from tests.guarded import PIPE, Guarded
from tests.rabbitmq import _free_ports

SUITE = "rest"
ROLES = ("robot", "brain", "motion", "visitor", "memory", "eyes", "ears", "voice", "social", "show")
RECORDING = ("--robot", "recording")


class Start(NamedTuple):
    """A way to start; `more` is appended to lumen.yaml, and `nodes` (0: one for each robot) are examined."""

    name: str
    options: Sequence[str]
    bus: str = "memory"
    robots: int = 1
    more: str = ""
    nodes: int = 0


MEMORY = [
    Start("run-recording", RECORDING),
    Start("run-recording-max-story", (*RECORDING, "--speed", "max", "--story", "visitor")),
    Start("run-recording-manual-reload", (*RECORDING, "--reload", "manual")),
    Start("run-recording-no-reload", (*RECORDING, "--reload", "off")),
    Start("run-recording-record", (*RECORDING, "--record", "all.mcap")),
    Start("run-recording-console", RECORDING, more="console: {port: PORT}\n"),
    Start("run-recording-modules", RECORDING, more="modules: {memory: {here: true}, social: {here: true}}\n"),
    Start("run-simulation", ("--robot", "simulation")),
    Start("run-none", ("--robot", "none")),
    Start("house-recording", RECORDING, robots=2),
    Start("house-recording-one-of-two", (*RECORDING, "--robot-name", "ben"), robots=2, nodes=1),
    Start("house-recording-max-story", (*RECORDING, "--speed", "max", "--story", "visitor"), robots=2),
]
BROKER = [
    Start("broker-run-recording", RECORDING, "broker"),
    Start("broker-run-remote", ("--robot", "remote"), "broker"),
    *(Start(f"broker-only-{role}", ("--only", role, *RECORDING), "broker") for role in ROLES),
    Start("broker-only-robot-brain-motion-visitor", ("--only", "robot,brain,motion,visitor", *RECORDING), "broker"),
    Start(
        "broker-only-with-story", ("--only", "robot,brain,motion,visitor", *RECORDING, "--story", "visitor"), "broker"
    ),
    Start("broker-house-recording", RECORDING, "broker", 2),
    *(Start(f"broker-house-only-{role}", ("--only", role, *RECORDING), "broker", 2) for role in ROLES[:4]),
]


OPENED = {
    "open-simulation": {"robot": "simulation"},
    "open-broker": {"robot": "recording", "speed": "1"},
}
"""Arguments of `lumen.open`; more of it is in the subject `opened`."""
NAOQI = Start("run-naoqi", ("--robot", "naoqi"))


def record(folder: Path) -> None:
    with tempfile.TemporaryDirectory() as place, Warm(Path(place)) as warm:
        here = Path(place).resolve()
        for start in MEMORY:
            _record(start, "memory://", here, warm, folder)
        with _fake_nao() as address:
            _record(NAOQI, "memory://", here, warm, folder, "--robot-url", address)
        with broker() as url:
            for start in BROKER:
                _record(start, url, here, warm, folder)
            for name, options in OPENED.items():
                _opened(name, {**options, "bus": url} if "broker" in name else options, here, warm, folder)


@contextmanager
def _fake_nao() -> Iterator[str]:
    """Run a NAOqi in a process of its own; yield its address."""
    with Guarded([sys.executable, "-m", "tests.features.naoqi"], cwd=ROOT, stdout=PIPE, text=True) as process:
        assert process.stdout
        yield process.stdout.readline().split()[-1]
        process.terminate()


def _record(start: Start, url: str, here: Path, warm: Warm, folder: Path, *more: str) -> None:
    project = small(here / start.name, robots=start.robots, more=start.more.replace("PORT", str(*_free_ports(1))))
    line = ["run", project, *start.options, *more, "--bus", url]
    done = warm.run(line, project, nodes=start.nodes or start.robots)
    written(folder, start.name, f"lumen run {' '.join(start.options)}", done, project)


def _opened(name: str, options: dict[str, str], here: Path, warm: Warm, folder: Path) -> None:
    project = small(here / name)
    done = warm.run(["open", json.dumps({"path": str(project), **options})], project, nodes=1)
    told = ", ".join(f"{key}={value!r}" for key, value in options.items() if key != "bus")
    written(folder, name, f"lumen.open({told})", done, project)
