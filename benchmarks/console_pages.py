"""Waiting times at the console's pages, and the cost of open pages for its server; part of console.py.

The shipped exhibition with the recording robot, and its console, are processes of their own. Each person has the page
Now in a Chromium without shared storage, so each has a stream of events. One, four and twelve pages are open.

- event to pixel: from a message on the bus until a page has painted a frame with the words in it;
- click to command: from the click in the page until another module on the bus has the command;
- CPU: of the console's server, while nothing happens and during a visit, as a share of one core.

With another checkout, the two are measured in turns.
"""

import json
import os
import shutil
import statistics
import sys
import time
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from queue import SimpleQueue
from threading import Event, Thread
from typing import Any, NamedTuple

sys.path.insert(0, str(Path(__file__).parents[1]))

from tests.copying import SHIPPED_FOLDERS
from tests.features.console.chromium import REST, Chromium
from tests.features.console.pages import Browser
from tests.guarded import DEVNULL, PIPE, Guarded, temporary_folder
from tests.servers import PORT, Servers
from tests.waiting import until

ROOT = Path(__file__).parents[1]
MODULE = Path(__file__).with_name("console_module.py")
PAGES = (1, 4, 12)
"""The numbers of open pages."""
MESSAGES, SAYS, RESTS = 20, 6, 3
"""The number of measurements in a round; after a Rest the robot first gets up again."""
WAIT = 180.0
SETTLED = 2.0
"""Time before each measurement of CPU [s]."""
TICKS_PER_SECOND = os.sysconf("SC_CLK_TCK")
HEARD, FACE = "lumen.NAO.audio.speech.recognition", "lumen.NAO.visual.face.detection"
STOP, COMMAND = "avatar.NAO.stop", "avatar.NAO.command"
RESUME = {"type": "motion", "method": "resume", "parameter": {}}
NOBODY = "title: Nobody comes\nsteps: [{wait: 5h}]\n"
"""A story in place of the visitor whom `lumen run` plays: faces and words are messages of this benchmark."""
FACES = 0.25
"""The time between two messages about a face [s]."""
VISIT = ((7.0, "my name is Budi"), (11.0, "I am fine"), (16.0, "what is a robot"), (21.0, "dance"))
"""The visitor's words, each with its time in the visit [s]."""
PAINTED = """
// `seen` becomes the time of the first frame in which `holds()` is true, in seconds since 1970.
globalThis.seen = 0;
const holds = new Function(`return ${arguments[0]}`);
const observer = new MutationObserver(() => {
  if (!holds()) return;
  observer.disconnect();
  requestAnimationFrame(() => {
    const { port1, port2 } = new MessageChannel();  // its message comes after the frame
    port1.onmessage = () => { globalThis.seen = (performance.timeOrigin + performance.now()) / 1000; };
    port2.postMessage(0);
  });
});
observer.observe(document.body, { subtree: true, childList: true, characterData: true, attributes: true });
"""
CLICKED = """
globalThis.clicked = 0;  // becomes the time of the next click, in seconds since 1970
addEventListener("click", (event) => {
  globalThis.clicked = (performance.timeOrigin + event.timeStamp) / 1000;
}, { capture: true, once: true });
"""
ROWS = ("event to pixel", "Say: click to command", "Rest: click to command")
COSTS = ("CPU, nothing happens", "CPU, a visit")


class Round(NamedTuple):
    """The results of a round with a number of pages: times [s] by row, and shares of a core by row."""

    times: dict[str, list[float]]
    costs: dict[str, float]


class Module:
    """The process of a module on the bus."""

    def __init__(self, folder: Path, environment: dict[str, str]) -> None:
        line = [sys.executable, MODULE, folder, STOP, COMMAND]
        self.process: Guarded[str] = Guarded(line, stdin=PIPE, stdout=PIPE, text=True, env=environment)
        self._lines = SimpleQueue[dict[str, Any]]()
        Thread(target=self._read, daemon=True).start()
        self._next("ready")

    def send(self, key: str, body: Any) -> float:
        """Send a message, and return when it was sent [s]."""
        assert self.process.stdin
        print(json.dumps({"key": key, "body": body}), file=self.process.stdin, flush=True)
        return self._next("sent")

    def arrival(self) -> float:
        """Return when the next command arrives [s]."""
        return self._next("arrived")

    def forget(self) -> None:
        """Forget the commands that have arrived."""
        while not self._lines.empty():
            self._lines.get()

    def _next(self, what: str) -> float:
        while what not in (line := self._lines.get(timeout=WAIT)):
            pass
        return float(line[what])

    def _read(self) -> None:
        assert self.process.stdout
        with suppress(ValueError):  # it was closed
            for line in self.process.stdout:
                self._lines.put(json.loads(line))


class Served:
    """An exhibition and its console, of one checkout."""

    def __init__(self, stack: ExitStack, checkout: Path) -> None:
        folder = temporary_folder("lumen-console-")
        stack.callback(shutil.rmtree, folder, ignore_errors=True)
        shutil.copy(checkout / "lumen.yaml", folder)
        for name in (name for name in SHIPPED_FOLDERS if (checkout / name).is_dir()):
            shutil.copytree(checkout / name, folder / name)
        environment = {**os.environ, "PYTHONPATH": f"{checkout / 'engine'}{os.pathsep}{checkout}"}
        lumen = [sys.executable, "-m", "lumen"]
        (folder / "behaviors/stories/nobody.yaml").write_text(NOBODY)
        run = [*lumen, "run", folder, "--robot", "recording", "--speed", "1", "--story", "nobody"]
        self._exhibition = Guarded(run, stdin=DEVNULL, stdout=DEVNULL, env=environment)
        stack.callback(_end, self._exhibition)
        line = [*lumen, "console", folder, "--port", "0"]
        self.console: Guarded[str] = Guarded(line, stdin=DEVNULL, stdout=PIPE, text=True, env=environment)
        stack.callback(_end, self.console)
        assert self.console.stdout
        self.address = "http://" + self.console.stdout.readline().split("http://")[1].split("/")[0] + "/"
        self.browser = Browser(self.address)
        until(lambda: [one["connected"] for one in self.browser.robots] == [True], WAIT)
        self.module = Module(folder, environment)
        stack.callback(_end, self.module.process)

    @property
    def robot(self) -> dict[str, Any]:
        return dict(self.browser.robots[0])

    def idle(self) -> None:
        """Let the robot wait for a visitor."""
        if self.robot["stopped"]:
            self.module.send(STOP, RESUME)
            until(lambda: not self.robot["stopped"], WAIT)
            self.browser.command("resume", robot="NAO")
        until(lambda: "watching" in self.robot["configuration"], WAIT)
        self.browser.command("goto", robot="NAO", state="idle")
        until(lambda: "idle" in self.robot["configuration"], WAIT)

    def cpu(self) -> float:
        """Return the CPU time of the console's server and of its ended jobs so far [s]."""
        fields = Path(f"/proc/{self.console.pid}/stat").read_text().rpartition(")")[2].split()
        return sum(map(int, fields[11:15])) / TICKS_PER_SECOND


def _end(process: Guarded[Any]) -> None:
    process.kill()
    process.wait()


def look(served: Served, person: Chromium) -> None:
    """Open the page Now, and wait until it shows the robot's states."""
    person.open(f"{served.address}robot/NAO")
    until(lambda: person.run("return Boolean(document.querySelector('.leaf')?.checkVisibility())"), WAIT)


def painted(person: Chromium) -> float:
    """Return when the page painted what it waits for [s]."""
    until(lambda: person.run("return globalThis.seen"), WAIT)
    return float(person.run("return seen"))


def times(served: Served, person: Chromium, number: int) -> dict[str, list[float]]:
    """Measure the times at one person's page; `number` makes the words new."""
    found: dict[str, list[float]] = {row: [] for row in ROWS}
    for turn in range(MESSAGES):
        words = f"blue cheese {number} and {turn}."
        person.run(PAINTED, f"document.body.textContent.includes({json.dumps(words)})")
        sent = served.module.send(HEARD, {"result": words, "language": "en"})
        found[ROWS[0]].append(painted(person) - sent)
        Event().wait(0.1)
    for turn in range(SAYS):
        person.find(".say input").send_keys(f"Word {turn}")
        found[ROWS[1]].append(_clicked(served, person, ".say button.strong"))
        until(lambda: person.run("return document.querySelector('.say input').value") == "", WAIT)
    for _ in range(RESTS):
        found[ROWS[2]].append(_clicked(served, person, REST))
        until(lambda: served.robot["stopped"], WAIT)
        person.quiet()
        served.idle()
    return found


def _clicked(served: Served, person: Chromium, selector: str) -> float:
    """Click, and return the time until the command is on the bus [s]."""
    person.run(CLICKED)
    served.module.forget()
    person.find(selector).click()
    arrived = served.module.arrival()
    return arrived - float(person.run("return clicked"))


def costs(served: Served, seconds: float) -> dict[str, float]:
    """Measure the console's CPU for that long while nothing happens, then during a visit."""
    served.idle()
    Event().wait(SETTLED)
    began, before = time.monotonic(), served.cpu()
    Event().wait(seconds)
    nothing = (served.cpu() - before) / (time.monotonic() - began)
    began, before = time.monotonic(), served.cpu()
    said = list(VISIT)
    while (now := time.monotonic() - began) < VISIT[-1][0] + 5.0:
        served.module.send(FACE, {"x": 160, "y": 120})
        if said and now >= said[0][0]:
            served.module.send(HEARD, {"result": said.pop(0)[1], "language": "en"})
        Event().wait(FACES)
    visit = (served.cpu() - before) / (time.monotonic() - began)
    assert served.robot["visitor"] == "Budi", "the visitor was not understood"
    served.idle()
    return {COSTS[0]: nothing, COSTS[1]: visit}


def measured(checkout: Path, people: Sequence[Chromium], number: int, seconds: float) -> dict[int, Round]:
    """One round with a checkout: each number of pages."""
    found = {}
    with ExitStack() as stack:
        served = Served(stack, checkout)
        opened = 0
        for pages in PAGES:
            for person in people[opened:pages]:
                look(served, person)
            opened = pages
            served.idle()
            found[pages] = Round(times(served, people[0], 100 * number + pages), costs(served, seconds))
        for person in people:
            person.open("about:blank")
    return found


@contextmanager
def chromiums() -> Iterator[list[Chromium]]:
    """Yield as many people's browsers as there are pages at most."""
    servers = Servers()
    os.environ[PORT] = str(servers.port)
    people: list[Chromium] = []
    try:
        people += (Chromium() for _ in range(PAGES[-1]))
        yield people
    finally:
        for person in people:
            person.close()
        servers.close()


def print_pages(rounds: int, seconds: float, against: Path | None) -> None:
    """Measure so many rounds, and print a table for each checkout, then the ratio if there are two."""
    checkouts = {"here": ROOT} | ({"there": against.resolve()} if against else {})
    found: dict[str, list[dict[int, Round]]] = {name: [] for name in checkouts}
    with chromiums() as people:
        for number in range(rounds):
            for name, checkout in checkouts.items() if number % 2 == 0 else reversed(checkouts.items()):
                found[name].append(measured(checkout, people, number, seconds))
    print(f"\npages in Chromium: medians and quartiles of {rounds} rounds, each of {MESSAGES} messages, {SAYS} Say and")
    print(f"{RESTS} Rest, {seconds:g} s in which nothing happens, and a visit of {VISIT[-1][0] + 5:g} s")
    head = "".join(f"{f'{pages} page' + 's' * (pages > 1):>26}" for pages in PAGES)
    for name, each in found.items():
        print(f"\n{name:24}{head}")
        for row in ROWS:
            print(f"{row:24}" + "".join(f"{_spread(_all(each, row, pages), 1000, ' ms'):>26}" for pages in PAGES))
        for row in COSTS:
            print(f"{row:24}" + "".join(f"{_spread(_all(each, row, pages), 100, ' %'):>26}" for pages in PAGES))
    if against:
        print(f"\n{'here : there':24}{head}")
        for row in (*ROWS, *COSTS):
            ratios = (
                statistics.median(_all(found["here"], row, pages)) / statistics.median(_all(found["there"], row, pages))
                for pages in PAGES
            )
            print(f"{row:24}" + "".join(f"{ratio:>26.2f}" for ratio in ratios))


def _all(rounds: Sequence[dict[int, Round]], row: str, pages: int) -> list[float]:
    """Return the values of a row in all rounds."""
    if row in COSTS:
        return [one[pages].costs[row] for one in rounds]
    return [value for one in rounds for value in one[pages].times[row]]


def _spread(values: list[float], factor: float, unit: str) -> str:
    first, middle, third = (factor * value for value in quartiles(values))
    return f"{middle:.1f}{unit} ({first:.1f} to {third:.1f})"


def quartiles(values: list[float]) -> tuple[float, float, float]:
    """Return the lower quartile, the median and the upper quartile."""
    if len(values) < 2:
        return (values[0],) * 3
    first, middle, third = statistics.quantiles(values, n=4, method="inclusive")
    return first, middle, third
