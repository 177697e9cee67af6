"""Measure Lumen Server while the robot dances: the rate and the worst gap of each sense, and the time to an answer.

    python benchmarks/server.py [--bus amqp://USER:PASSWORD@HOST/] [--robot simulation|recording]

The robot is a separate process (`lumen run --only robot`), and this process is a module on the same broker, which is
a private one by default. Gaps are measured in periods of the route: once where the robot makes the readings, and once
where the messages arrive. The delay of an image is the time from its capture to its arrival, compared with the
fastest image. The paper has these measurements in Fig. 10 and 11; its server executed commands on one thread, so a
dance delayed every later command by its 13 s.
"""

import argparse
import os
import platform
import statistics
import sys
import threading
import time
from collections import defaultdict
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

from tests.guarded import DEVNULL, PIPE, Guarded

import lumen
from lumen.bus import Bus, Message, connect
from lumen.language.projects import Project
from lumen.ports import Sense

ROOT = Path(__file__).parents[1]
OURS = f" of {os.getpid()}"
"""The end of this process's command ids: the robot performs no id twice, not even after a restart."""
LIMIT = 1.5
"""The greatest accepted gap [periods]."""


class Ear:
    """Records the messages of the senses and the reports, each with its time of arrival [s]."""

    def __init__(self, bus: Bus) -> None:
        self.senses: dict[str, list[tuple[float, float]]] = defaultdict(list)
        self.reports: dict[tuple[str, str], float] = {}
        self.changed = threading.Condition()
        bus.subscribe("avatar.NAO.data.*", self._sense)
        bus.subscribe("avatar.NAO.event.command", self._report)

    def _sense(self, message: Message) -> None:
        with self.changed:
            self.senses[message.key.rpartition(".")[2]].append((time.monotonic(), float(message.body["time"])))
            self.changed.notify_all()

    def _report(self, message: Message) -> None:
        with self.changed:
            self.reports.setdefault((message.body["id"].removesuffix(OURS), message.body["state"]), time.monotonic())
            self.changed.notify_all()

    def listen(self, joints: int, patience: float = 60.0) -> None:
        """Wait for that many joint messages: by then the first image is rendered, which takes longest.

        Raise SystemExit after `patience` [s].
        """
        with self.changed:
            if not self.changed.wait_for(lambda: len(self.senses[Sense.JOINT]) >= joints, patience):
                raise SystemExit(f"no angles came within {patience:.0f} s")

    def wait(self, id: str, state: str, patience: float = 60.0) -> float:
        """Wait until a command reaches a state; return the time [s]. Raise SystemExit after `patience` [s]."""
        with self.changed:
            if not self.changed.wait_for(lambda: (id, state) in self.reports, patience):
                raise SystemExit(f"the robot did not say within {patience:g} s that `{id}` is {state}")
        return self.reports[id, state]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--bus", metavar="URL")
    parser.add_argument("--robot", choices=("simulation", "recording"), default="simulation")
    options = parser.parse_args()
    project = lumen.load(ROOT)
    with broker(options.bus) as url, robot(url, options.robot):
        bus = connect(url)
        ear = Ear(bus)
        began, ended, answers = dance(bus, ear)
        bus.close()
    print(f"{platform.processor() or platform.machine()}, {os.cpu_count()} cores, Python {platform.python_version()}")
    print(f"robot: {options.robot}; a dance of {ended - began:.1f} s, over RabbitMQ\n")
    well = table(project, ear, began, ended)
    print(f"\n{len(answers)} commands during the dance, until the robot has said that it has them:")
    print(f"  median {1000 * statistics.median(answers):.1f} ms, worst {1000 * max(answers):.1f} ms")
    return 0 if well else 1


def dance(bus: Bus, ear: Ear) -> tuple[float, float, list[float]]:
    """Let the robot dance; return its begin and end, and the response time of each other command [s]."""
    order(bus, "wake", "wakeUp")
    ear.wait("wake", "finished")
    ear.listen(30)
    order(bus, "dance", "dance")
    began = ear.wait("dance", "started")
    answers, number = [], 0
    while ("dance", "finished") not in ear.reports:
        number += 1
        sent = order(bus, f"say{number}", "say", text="Yes")
        answers.append(ear.wait(f"say{number}", "accepted") - sent)
        with ear.changed:
            ear.changed.wait_for(lambda: ("dance", "finished") in ear.reports, 1.0)
    return began, ear.reports["dance", "finished"], answers


def order(bus: Bus, id: str, method: str, **parameter: object) -> float:
    """Send a command; return the time [s]."""
    sent = time.monotonic()
    bus.publish("avatar.NAO.command", {"id": f"{id}{OURS}", "type": "motion", "method": method, "parameter": parameter})
    return sent


def table(project: Project, ear: Ear, began: float, ended: float) -> bool:
    """Print the rates and gaps of each sense between those times; return True if every gap is accepted."""
    print(f"{'sense':10}{'period':>9}{'messages':>10}{'rate':>10}{'worst gap':>12}{'… on arrival':>14}")
    well = True
    for sense in Sense:
        period = project.routes[sense].every or 0.1
        heard = [(at, made) for at, made in ear.senses[sense] if began <= at <= ended]
        if len(heard) < 3:
            print(f"{sense:10}{1000 * period:6.0f} ms{len(heard):10}   too few to tell")
            well &= sense is Sense.BATTERY or sense is Sense.IMAGE
            continue
        made, came = worst([m for _, m in heard]) / period, worst([at for at, _ in heard]) / period
        rate = (len(heard) - 1) / (heard[-1][0] - heard[0][0])
        print(f"{sense:10}{1000 * period:6.0f} ms{len(heard):10}{rate:7.1f} Hz{made:10.2f} p{came:12.2f} p")
        well &= max(made, came) <= LIMIT
    images = [at - made for at, made in ear.senses[Sense.IMAGE] if began <= at <= ended]
    if images:
        way = [1000 * (late - min(images)) for late in images]
        print("\nan image's way here, beyond the fastest:", end=" ")
        print(f"median {statistics.median(way):.0f} ms, worst {max(way):.0f} ms")
    return well


def worst(times: list[float]) -> float:
    """Return the greatest gap between consecutive times."""
    return max(after - before for before, after in pairwise(times))


@contextmanager
def robot(url: str, kind: str) -> Iterator[None]:
    """Run the robot in a process of its own, once it is available."""
    line = [sys.executable, "-m", "lumen", "run", str(ROOT), "--only", "robot", "--robot", kind, "--bus", url]
    with Guarded(line, stdout=PIPE, stdin=DEVNULL, text=True) as process:
        assert process.stdout
        print(process.stdout.readline(), end="")
        try:
            yield
        finally:
            process.terminate()


@contextmanager
def broker(url: str | None) -> Iterator[str]:
    """Yield the address of the given broker, else of a private one."""
    if url:
        yield url
        return
    sys.path.insert(0, str(ROOT))
    from tests.rabbitmq import RabbitMQ

    own = RabbitMQ()
    own.start()
    try:
        yield own.url
    finally:
        own.stop()


if __name__ == "__main__":
    sys.exit(main())
