"""Measure how soon a stop is accepted, and the rates of the senses, while messages flood in on a busy machine.

    python benchmarks/load.py [--robot recording|simulation] [--crowd N] [--rate 2000] [--stops 100] [--kinds face,all]

The exhibition is a separate process on a private RabbitMQ, and so is the sender of the flood. This process measures
each stop from the time at which it is sent until the report `accepted` arrives. `--crowd 4` starts four processes for
each core that only compute. The first row is without a flood; the senses of the other rows are compared with it.
After each flood a text is sent, and the time until the robot says it is measured.
"""

import argparse
import json
import os
import platform
import statistics
import sys
import threading
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from itertools import count, cycle
from pathlib import Path
from typing import Any, NamedTuple

sys.path.insert(0, str(Path(__file__).parents[1]))

import pika
from tests.guarded import DEVNULL, PIPE, STDOUT, Guarded, temporary_folder
from tests.rabbitmq import RabbitMQ

import lumen
from lumen.language.projects import Project

ROOT = Path(__file__).parents[1]
KINDS = ("quiet", "face", "command", "all")
STOP, COMMAND, REPORT = "avatar.NAO.stop", "avatar.NAO.command", "avatar.NAO.event.command"
SENSES = ("joint", "sonar", "tactile")
PAUSE, PATIENCE = 0.05, 60.0
"""Pause between two stops, and the timeout of all waits [s]."""
BATCH = 0.005
"""Interval at which the flood sends its due messages [s]."""


class Result(NamedTuple):
    """The results for one kind of flood."""

    stops: list[float]
    """Times until each stop was accepted [s]."""
    senses: dict[str, float]
    """Messages per second of each sense."""
    spoken: float
    """Time until the text was said [s]."""
    sent: float
    """Messages per second that the flood has sent."""
    dropped: str
    """The exhibition's line about dropped messages; empty without any."""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--robot", choices=("recording", "simulation"), default="recording")
    parser.add_argument("--crowd", type=int, default=0, metavar="N", help="busy processes for each core (default: 0)")
    parser.add_argument("--rate", type=int, default=2_000, help="messages of the flood a second")
    parser.add_argument("--stops", type=int, default=100, help="how many stops are timed in each row")
    parser.add_argument("--kinds", default=",".join(KINDS), help=f"which floods, of {', '.join(KINDS)}")
    parser.add_argument("--flood", nargs=2, metavar=("KIND", "URL"), help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.flood:
        flood(*options.flood, options.rate)
        return
    print(f"{platform.machine()}, {os.cpu_count()} cores, CPython {platform.python_version()}, {options.robot} robot,")
    print(f"{options.rate} messages a second, {options.crowd} busy processes for each core, {options.stops} stops\n")
    print(f"{'flood':<9}{'sent/s':>8}{'stop p50':>10}{'p95':>9}{'worst':>9}  {'senses':<28}{'then said':>10}")
    usual: dict[str, float] = {}
    with ExitStack() as stack:
        broker = RabbitMQ()
        broker.start()
        stack.callback(broker.stop)
        for kind in options.kinds.split(","):
            result = measured(broker.url, kind, options)
            usual = usual or result.senses
            show(kind, result, usual)


def show(kind: str, result: Result, usual: dict[str, float]) -> None:
    """Print a row of the table, and below it the dropped messages."""
    late = sorted(1000 * seconds for seconds in result.stops)
    kept = " ".join(f"{name} {result.senses[name] / max(usual[name], 0.1):.2f}" for name in SENSES)
    p95 = late[int(0.95 * len(late))]
    times = f"{statistics.median(late):>7.1f} ms{p95:>6.0f} ms{late[-1]:>6.0f} ms"
    print(f"{kind:<9}{result.sent:>8,.0f}{times}  {kept:<28}{result.spoken:>8.1f} s", flush=True)
    if result.dropped:
        print(f"{'':<9}{result.dropped}", flush=True)


def measured(url: str, kind: str, options: argparse.Namespace) -> Result:
    """Measure one row, with an exhibition of its own."""
    with ExitStack() as stack:
        house, told = stack.enter_context(exhibition(url, options.robot))
        asker = Asker(url)
        stack.callback(asker.close)
        asker.begin()
        crowd = [stack.enter_context(busy()) for _ in range(options.crowd * (os.cpu_count() or 1))]
        flooder = stack.enter_context(flooding(url, kind, options.rate)) if kind != "quiet" else None
        asker.settle()
        stops = [asker.stop() for _ in range(options.stops)]
        senses = asker.rates()
        sent = ended(flooder) if flooder else 0.0
        spoken = asker.say("Hello")
        for process in crowd:
            process.kill()
        house.terminate()
        house.wait(PATIENCE)
    lost = [line.strip() for line in told.read_text("utf-8").splitlines() if "dropped messages:" in line]
    return Result(stops, senses, spoken, sent, lost[0] if lost else "")


class Asker:
    """Sends stops and a text, and counts the messages of the senses meanwhile, with pika's own connection."""

    def __init__(self, url: str) -> None:
        self._connection = pika.BlockingConnection(pika.URLParameters(url))
        self._channel, self._numbers = self._connection.channel(), count()
        self._mark = f"{os.getpid()}.{time.time():.0f}"
        self._reports: dict[tuple[str, str], float] = {}
        self._ear = Ear(url)
        queue = self._channel.queue_declare("", exclusive=True).method.queue
        self._channel.queue_bind(queue, "amq.topic", REPORT)
        self._channel.basic_consume(queue, self._heard, auto_ack=True)

    def begin(self) -> None:
        """Wait until the robot is available."""
        if not self._ear.heard.wait(PATIENCE):
            raise SystemExit("the exhibition has not begun")
        self.stop()

    def stop(self) -> float:
        """Send a stop; return the time until it was accepted [s]."""
        sent = self._send(STOP, "stop", {"what": "walk"})
        late = self._wait(sent, "accepted")
        self._connection.sleep(PAUSE)
        return late

    def say(self, text: str) -> float:
        """Return the time until a text was said [s]; it is sent again after a refusal.

        Raise SystemExit if it was not said within `PATIENCE`.
        """
        began = time.monotonic()
        while time.monotonic() - began < PATIENCE:
            sent = self._send(COMMAND, "say", {"text": text})
            with suppress(TimeoutError):
                self._wait(sent, "finished", 1.0)
                return time.monotonic() - began
            if self._came(sent[0], "accepted"):
                self._wait(sent, "finished")
                return time.monotonic() - began
        raise SystemExit("the text was never said")

    def settle(self) -> None:
        """Wait until the flood has reached its rate, then start to count."""
        self._connection.sleep(2.0)
        self._ear.begin()

    def rates(self) -> dict[str, float]:
        """Return the messages per second of each sense."""
        return self._ear.rates()

    def close(self) -> None:
        """Close both connections."""
        self._ear.close()
        self._connection.close()

    def _send(self, key: str, method: str, parameter: dict[str, str]) -> tuple[str, float]:
        id, at = f"{self._mark}.{next(self._numbers)}", time.monotonic()
        body = {"type": "motion", "method": method, "parameter": parameter, "id": id}
        self._channel.basic_publish("amq.topic", key, json.dumps(body).encode())
        return id, at

    def _wait(self, sent: tuple[str, float], state: str, patience: float = PATIENCE) -> float:
        id, at = sent
        while not self._came(id, state):
            if time.monotonic() - at > patience:
                raise TimeoutError(f"{id} was not {state} within {patience:g} s")
            self._connection.process_data_events(0.1)
        return self._reports[id, state] - at

    def _came(self, id: str, state: str) -> bool:
        return (id, state) in self._reports

    def _heard(self, _: Any, method: Any, properties: Any, body: bytes) -> None:
        report = json.loads(body)
        if str(report["id"]).startswith(self._mark):
            self._reports.setdefault((report["id"], report["state"]), time.monotonic())


class Ear:
    """Counts the messages of the senses, on a thread of its own."""

    def __init__(self, url: str) -> None:
        self._counts, self._began = Counter[str](), 0.0
        self.heard = threading.Event()
        self._connection = pika.BlockingConnection(pika.URLParameters(url))
        channel = self._connection.channel()
        queue = channel.queue_declare("", exclusive=True).method.queue
        for sense in SENSES:
            channel.queue_bind(queue, "amq.topic", f"avatar.NAO.data.{sense}")
        channel.basic_consume(queue, self._heard, auto_ack=True)
        self._ending = False
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def begin(self) -> None:
        """Start to count."""
        self._counts.clear()
        self._began = time.monotonic()

    def rates(self) -> dict[str, float]:
        """Return the messages per second of each sense since the start."""
        passed = time.monotonic() - self._began
        return {sense: self._counts[sense] / passed for sense in SENSES}

    def close(self) -> None:
        """End the thread and close the connection."""
        self._ending = True
        self._thread.join()
        self._connection.close()

    def _run(self) -> None:
        while not self._ending:
            self._connection.process_data_events(0.2)

    def _heard(self, _: Any, method: Any, properties: Any, body: bytes) -> None:
        if b'"lost"' not in body:  # messages of the flood to these keys are not the robot's
            self._counts[method.routing_key.rpartition(".")[2]] += 1
            self.heard.set()


@contextmanager
def exhibition(url: str, robot: str) -> Iterator[tuple[Guarded[bytes], Path]]:
    """Yield the whole exhibition in a process of its own, and the file with its output."""
    told = temporary_folder("lumen-load-") / "told.txt"
    line = [sys.executable, "-m", "lumen", "run", ROOT, "--robot", robot, "--bus", url, "--reload", "off", "--fresh"]
    with told.open("wb") as file, Guarded(line, stdin=DEVNULL, stdout=file, stderr=STDOUT) as process:
        try:
            yield process, told
        finally:
            process.kill()


@contextmanager
def busy() -> Iterator[Guarded[bytes]]:
    """Yield a process that uses a core for nothing."""
    with Guarded([sys.executable, "-c", "while True: pass"]) as process:
        try:
            yield process
        finally:
            process.kill()


@contextmanager
def flooding(url: str, kind: str, rate: int) -> Iterator[Guarded[str]]:
    """Yield a process that sends a flood, once it has begun."""
    line = [sys.executable, __file__, "--flood", kind, url, "--rate", str(rate)]
    with Guarded(line, stdin=PIPE, stdout=PIPE, text=True) as process:
        assert process.stdout
        process.stdout.readline()
        try:
            yield process
        finally:
            process.kill()


def ended(process: Guarded[str]) -> float:
    """End a flood; return the messages per second that it has sent."""
    return float(process.communicate("\n")[0])


def flood(kind: str, url: str, rate: int) -> None:
    """Send until a line arrives on standard input; then print the rate [messages per second]."""
    connection = pika.BlockingConnection(pika.URLParameters(url))
    channel, messages = connection.channel(), cycle(messages_of(kind, lumen.load(ROOT)))
    ending = threading.Event()
    threading.Thread(target=lambda: (sys.stdin.readline(), ending.set()), daemon=True).start()
    print("flowing", flush=True)
    began, sent = time.monotonic(), 0
    while not ending.is_set():
        due = int((time.monotonic() - began) * rate) - sent
        for key, body in (next(messages) for _ in range(min(due, rate))):
            channel.basic_publish("amq.topic", key, body)
        sent += min(due, rate)
        connection.process_data_events(0)
        ending.wait(BATCH)
    print(sent / (time.monotonic() - began))
    connection.close()


def messages_of(kind: str, project: Project) -> list[tuple[str, bytes]]:
    """Return the messages of a flood: their bodies are valid, so that they are processed the farthest."""
    says = {"type": "texttospeech", "method": "say", "parameter": {"text": "This is a flood, and nobody wants it."}}
    faces = [(project.routes["face"].key, json.dumps({"x": x, "y": 120}).encode()) for x in range(100, 220)]
    if kind == "face":
        return faces
    if kind == "command":
        return [(COMMAND, json.dumps(says).encode())]
    return [(route.key_for(project.robot), example(project, route.schema)) for route in project.routes.values()]


def example(project: Project, schema: str) -> bytes:
    """Return the example in a message's schema."""
    shown: Any = project.messages.get(schema, {}).get("examples", [{}])
    body = dict(shown[0]) if isinstance(shown[0], dict) else {"lost": True}
    return json.dumps({**body, "lost": True} if "session" not in body else body).encode()


if __name__ == "__main__":
    main()
