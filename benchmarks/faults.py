"""Measure what a visitor notices when a part of an exhibition fails, and how long until the tour continues.

    python benchmarks/faults.py [--count N] [--seed S] [--robot recording|simulation] [--parts brain,robot]
                                [--faults killed,paused3] [--moments dance] [--json FILE]

The robot, the brain and the motion module are separate processes on a private RabbitMQ, each with a connection that
this program can disturb. A scripted visitor says everything once, and stays. At each requested moment of the tour,
one part fails in one of these ways:

- it is killed, and started again at once, as systemd does;
- it is paused for 3 or 15 s;
- it is cut off for 8 s;
- its connection is half-open for 8 s: no data arrives, and neither side is informed;
- its connection is delayed for 8 s, by 0.5 s in each direction.

When the tour has continued, the same fault occurs again.

`silent` is the time for which the robot says nothing, from the beginning of the fault [s]. `on` is the time from the
end of the fault (for a killed part, from the kill) until the tour is back in its state and stays there [s]. `said`
has the sentences that the visitor hears and that are not part of the tour. TWICE names motions that began again
without a request. `rest` is whether the robot rested, with a ! if it did not rest although it must, or rested without
need: it must rest if its brain was unavailable for 5 s and the robot itself is running. The time of a start depends
on the machine. Without `--count` all combinations run; with it, a sample.
"""

import argparse
import json
import os
import random
import re
import shutil
import signal
import sys
import threading
import time
from collections import Counter, deque
from collections.abc import Callable, Collection, Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import Any, NamedTuple

sys.path.insert(0, str(Path(__file__).parents[1]))

from tests.guarded import DEVNULL, PIPE, STDOUT, Guarded, temporary_folder
from tests.rabbitmq import RabbitMQ
from tests.relay import Relay

import lumen
from lumen.bus import connect
from lumen.errors import BusError

ROOT = Path(__file__).parents[1]
PARTS = ("broker", "brain", "robot", "motion")
FAULTS = ("killed", "paused3", "paused15", "cut", "half-open", "delayed")
FAULT_PERIOD, DELAY = 8.0, 0.5
"""Duration of a cut, dead or slow wire [s], and the delay of a slow one [s]."""
READY_TIMEOUT, MOMENT_TIMEOUT, RETURN_TIMEOUT = 90.0, 150.0, 45.0
BRAIN_TIMEOUT = 5.0
PROBATION = 11.0
"""Time that a brain must run until its files are approved [s]; one that dies twice before starts from scratch."""
SETTLED = 6.0
"""Time that the tour must stay in its state [s]: a lost part is noticed after 4 s."""

SPOKEN = {
    "ask_name": "My name is Ada",
    "how_are_you": "fine",
    "offer": "Tell me about this stand",
    "any_question": "How tall are you?",
}
"""The visitor's answer in each state on the way to a moment."""
WISHES = {
    "explain": "Tell me about this stand", "dance": "dance", "sing": "sing", "photo": "photo", "goodbye": "no",
    "offer": "no", "idle": "no", "greet": "no", "ask_name": "no", "how_are_you": "no",
}  # fmt: skip
"""The visitor's request in an offer or a question, to reach a moment; "no" for moments of the next visit."""
MOMENTS = ("idle", "greet", "ask_name", "how_are_you", "offer", "explain", "any_question", "answer", "dance", "goodbye")
BACK = {
    "idle": ("idle", "greet"), "greet": ("greet", "ask_name"), "explain": ("explain", "any_question"),
    "answer": ("answer", "any_question"), "dance": ("dance", "offer"),
    "goodbye": ("goodbye", "idle", "greet", "ask_name"),
}  # fmt: skip
"""The states in which the tour may continue after a moment, because it moves on meanwhile; else the same state."""
APOLOGIES = ("lost my thoughts", "not hear", "I fell", "on my feet", "cannot", "have stopped")

LINE = re.compile(r"^ *\d+:\d\d\.\d  (\w+) +(.*)$")


class Told(NamedTuple):
    """A line of a transcript, with its time of arrival [s]."""

    at: float
    who: str
    text: str


class Part:
    """A process of the exhibition, which can be started, watched and restarted."""

    def __init__(self, name: str, command: Sequence[str]) -> None:
        self.name, self.told = name, list[Told]()
        self._command = command
        self.process: Guarded[str] | None = None
        self.begun = 0.0

    @property
    def age(self) -> float:
        """Return the time since its start [s]."""
        return time.monotonic() - self.begun

    def begin(self) -> None:
        """Start the process, and a thread that reads its output."""
        self.begun = time.monotonic()
        self.process = Guarded(self._command, text=True, stdin=DEVNULL, stdout=PIPE, stderr=STDOUT, bufsize=1)
        threading.Thread(target=self._read, args=(self.process,), daemon=True).start()

    def signal(self, number: int) -> None:
        """Send a signal to the process and its children."""
        assert self.process
        with suppress(ProcessLookupError):  # it ended by itself: `until` and the outcome of the fault report that
            os.killpg(self.process.pid, number)

    def end(self) -> None:
        """Kill the process and wait for its end."""
        if self.process:
            self.signal(signal.SIGKILL)
            self.process.wait()

    def since(self, at: float, who: str = "") -> list[Told]:
        """Return the lines since `at` [s], only those of `who` if it is given."""
        return [told for told in list(self.told) if told.at >= at and who in ("", told.who)]

    def _read(self, process: Guarded[str]) -> None:
        assert process.stdout
        for line in process.stdout:
            found = LINE.match(line)
            who, text = (found[1], found[2]) if found else ("note", line.strip())
            self.told.append(Told(time.monotonic(), who, text))


class Outcome(NamedTuple):
    """The outcome of one fault; times in [s]."""

    part: str
    fault: str
    moment: str
    again: bool
    """True for the second fault in a row."""
    silent: float
    """Time from the fault on without speech of the robot."""
    on: float | None
    """Time from the end of the fault until the tour has recovered; None if it has not."""
    at: str
    """The state afterwards."""
    said: list[str]
    """Apologies of the robot."""
    twice: list[str]
    """Motions that were repeated without a request."""
    rested: bool
    should_rest: bool | None
    """True if it had to rest, False if it must not; None if either is allowed."""

    @property
    def well(self) -> bool:
        """Return True if the tour has recovered, with nothing repeated and rest as required."""
        return self.on is not None and not self.twice and self.should_rest in (None, self.rested)


class Exhibition:
    """A broker, wires, processes, and a visitor."""

    def __init__(self, robot: str, stack: ExitStack) -> None:
        self.folder = _copy(temporary_folder("lumen-faults-"))
        self.broker = RabbitMQ()
        stack.callback(self.broker.stop)
        self.broker.start()
        self.wires = {name: Relay(self.broker.port) for name in ("brain", "robot", "motion")}
        self.parts = {name: Part(name, self._command(name, robot)) for name in ("robot", "motion", "brain")}
        for part in self.parts.values():
            stack.callback(part.end)
            part.begin()
        self._bus = connect(self.broker.url)
        stack.callback(self._bus.close)
        self.until(lambda: self.state == "idle", READY_TIMEOUT, "the tour begins")

    @property
    def state(self) -> str:
        """Return the guide's innermost state in the brain's last report since its start; empty in other states."""
        brain = self.parts["brain"]
        for told in reversed(brain.since(brain.begun)):
            names: list[str] = []
            if told.who == "state":
                names = told.text.partition("  (")[0].split(", ")
            elif told.text.startswith("The last run ended unexpectedly"):
                names = told.text.rpartition(" in ")[2].rstrip(".").split(", ")
            for name in reversed(names):
                if name in ("paused", "interrupted"):
                    return ""
                if name in (*MOMENTS, "sing", "photo", "fine", "not_understood"):
                    return name
        return ""

    def until(self, condition: Callable[[], object], patience: float, what: str) -> float:
        """Wait until the condition is true; return the time [s]. Raises TimeoutError."""
        deadline = time.monotonic() + patience
        while not condition():
            if time.monotonic() > deadline:
                last = "\n".join(f"{p.name}: {t.who} {t.text}" for p in self.parts.values() for t in p.told[-12:])
                raise TimeoutError(f"{what}: not within {patience:g} s; told last:\n{last}")
            time.sleep(0.02)
        return time.monotonic()

    def settled(self, wanted: Collection[str], over: float) -> float | None:
        """Return since when the tour has been in these states [s], once it stays there; None if it never does."""
        since, deadline = over, over + RETURN_TIMEOUT
        while time.monotonic() < deadline:
            now = time.monotonic()
            if self.state not in wanted:
                since = now
            elif now - since > SETTLED and now - over > SETTLED:
                return since
            time.sleep(0.02)
        return None

    def publish(self, key: str, body: Any) -> None:
        """Publish a message, repeatedly until the bus accepts it."""
        self.until(lambda: self._published(key, body), READY_TIMEOUT, f"a message on {key}")

    def _published(self, key: str, body: Any) -> bool:
        try:
            self._bus.publish(key, body)
        except BusError:
            return False
        return True

    def say(self, text: str) -> None:
        """Publish a sentence of the visitor."""
        self.publish("lumen.audio.speech.recognition", {"name": "Ada", "result": text, "date": "2026-01-01T10:00:00"})

    def reach(self, moment: str) -> None:
        """Bring the visit to a moment, from any state."""
        deadline, said = time.monotonic() + MOMENT_TIMEOUT, ""
        there = moment != "idle" or self.state != "idle"
        self.publish("avatar.NAO.hall", {"visitor": {"x": 1.2, "y": 0.0, "height": 1.65} if there else None})
        if self.state == moment in SPOKEN:  # start it again, because a visitor who is silent for 30 s is sent away
            self.say(SPOKEN[moment])
            self.until(lambda: self.state != moment, MOMENT_TIMEOUT, f"{moment} is left")
        while self.state != moment:
            state = self.state
            if time.monotonic() > deadline:
                raise TimeoutError(f"{moment} was not reached, but {state}")
            if state != said and state in SPOKEN:
                wish = WISHES.get(moment, SPOKEN[state]) if state in ("offer", "any_question") else SPOKEN[state]
                self.say(wish)
            said = state
            time.sleep(0.05)
            if moment == "idle":
                self.publish("avatar.NAO.hall", {"visitor": None})

    def fault(self, part: str, fault: str) -> float:
        """Cause a fault and wait for its end; return the time of the end [s]."""
        if fault == "killed":
            began = time.monotonic()
            self._kill(part)
            return began
        if fault.startswith("paused"):
            self._signal(part, signal.SIGSTOP)
            time.sleep(float(fault.removeprefix("paused")))
            self._signal(part, signal.SIGCONT)
            return time.monotonic()
        wires = list(self.wires.values()) if part == "broker" else [self.wires[part]]
        for wire in wires:
            if fault == "delayed":
                wire.delay = DELAY
            elif fault == "cut":
                wire.refuse()
            else:
                wire.cut()
        time.sleep(FAULT_PERIOD)
        for wire in wires:
            wire.delay = 0.0
            if fault == "half-open":
                wire.reset()
            wire.mend()
        return time.monotonic()

    def _kill(self, part: str) -> None:
        if part == "broker":
            self.broker.kill()
            self.broker.start()
        else:
            self.parts[part].end()
            self.parts[part].begin()

    def _signal(self, part: str, number: int) -> None:
        if part == "broker":
            self.broker.signal(number)
        else:
            self.parts[part].signal(number)

    def _command(self, name: str, robot: str) -> list[str]:
        url = f"amqp://guest:guest@127.0.0.1:{self.wires[name].port}/"
        words = [sys.executable, "-m", "lumen", "run", str(self.folder), "--only", name, "--bus", url]
        return [*words, "--robot", robot] if name == "robot" else words


def endure(exhibition: Exhibition, part: str, fault: str, moment: str, *, again: bool) -> Outcome:
    """Cause one fault at one moment; return the outcome."""
    reached = time.monotonic()
    if not again:
        exhibition.until(lambda: exhibition.parts["brain"].age > PROBATION, READY_TIMEOUT, "its files are approved")
    exhibition.reach(moment)
    time.sleep(1.0)  # in the middle of the moment
    robot = exhibition.parts["robot"]
    began = time.monotonic()
    over = exhibition.fault(part, fault)
    back = exhibition.settled(BACK.get(moment, (moment,)), over)
    said = [t for t in robot.since(began, "robot") if t.text.startswith("“")]
    apologies = [t.text for t in said if any(words in t.text for words in APOLOGIES)]
    played = Counter(t.text for t in robot.since(reached, "robot") if t.text == f"plays {moment}")
    rested = any("rests" in t.text for t in robot.since(began, "robot"))
    away = {"killed": 0.0, "paused3": 3.0, "paused15": 15.0, "delayed": 0.0}.get(fault, FAULT_PERIOD)
    return Outcome(
        part, fault, moment, again,
        silent=round((said[0].at if said else time.monotonic()) - began, 1),
        on=None if back is None else round(max(back - over, 0.0), 1),
        at=exhibition.state,
        said=apologies,
        twice=[text for text, times in played.items() if times > 1],
        rested=rested,
        should_rest=None if fault == "killed" else away > BRAIN_TIMEOUT and part != "motion",
    )  # fmt: skip


def _copy(folder: Path) -> Path:
    for name in ("behaviors", "functions", "knowledge", "fuzzy", "models", "motions", "schemas"):
        shutil.copytree(ROOT / name, folder / name)
    shutil.copy(ROOT / "lumen.yaml", folder)
    return folder


@contextmanager
def exhibition_with(robot: str) -> Iterator[Exhibition]:
    """Yield an exhibition with that robot."""
    with ExitStack() as stack:
        yield Exhibition(robot, stack)


def endured(exhibition: Exhibition, waiting: deque[tuple[str, str, str]]) -> Iterator[Outcome]:
    """Yield the outcomes of the waiting combinations, each twice, and remove them. Raises TimeoutError."""
    while waiting:
        part, fault, moment = waiting.popleft()
        for again in (False, True):
            yield endure(exhibition, part, fault, moment, again=again)


def table(outcomes: Sequence[Outcome]) -> str:
    """Return the outcomes as a printed table."""
    rows = [f"{'part':7} {'fault':10} {'moment':13}{'silent':>7}{'on':>7}  {'goes on at':13} rest   said"]
    for o in outcomes:
        on = "never" if o.on is None else f"{o.on:.1f}"
        rest = ("yes" if o.rested else "no") + ("" if o.should_rest in (None, o.rested) else " !")
        rows.append(
            f"{o.part:7} {o.fault:10} {o.moment:13}{o.silent:>7.1f}{on:>7}  {o.at:13} {rest:6} {' '.join(o.said)[:60]}"
            + "".join(f"  TWICE {text}" for text in o.twice)
        )
    well = sum(o.well for o in outcomes)
    return "\n".join([*rows, f"{well} of {len(outcomes)} go on, with nothing twice, and rest where they have to"])


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, help="how many combinations, drawn (default: all)")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--robot", choices=("recording", "simulation"), default="recording")
    parser.add_argument("--parts", default=",".join(PARTS))
    parser.add_argument("--faults", default=",".join(FAULTS))
    parser.add_argument("--moments", default=",".join(MOMENTS))
    parser.add_argument("--json", type=Path, help="write the outcomes there")
    options = parser.parse_args()
    every = [
        (part, fault, moment)
        for part in options.parts.split(",")
        for fault in options.faults.split(",")
        for moment in options.moments.split(",")
    ]
    drawn = random.Random(options.seed).sample(every, min(options.count or len(every), len(every)))
    outcomes: list[Outcome] = []
    waiting, unreached = deque(drawn), 0
    print(f"Lumen {lumen.__version__}, {len(drawn)} combinations, each twice in a row, robot: {options.robot}")
    while waiting:
        with exhibition_with(options.robot) as exhibition:
            try:
                for outcome in endured(exhibition, waiting):
                    outcomes.append(outcome)
                    print(table([outcome]).splitlines()[1], flush=True)
            except TimeoutError as error:  # a new exhibition continues with the next
                unreached += 1
                print(f"  no outcome: {error}", flush=True)
    print(table(outcomes).splitlines()[-1])
    if options.json:
        options.json.write_text(json.dumps([o._asdict() | {"well": o.well} for o in outcomes], indent=1))
    return int(unreached > 0 or not all(o.well for o in outcomes))


if __name__ == "__main__":
    sys.exit(main())
