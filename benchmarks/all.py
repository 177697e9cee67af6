"""Print the table of speeds: what was measured, the goal, and the figure on this machine.

    python benchmarks/all.py [--rows WORD] [--markdown]

Each figure comes from the script that measures it in detail, in a shorter form. Ratios compare with the named peer in
the same run. Figures that other programs on the machine could disturb are processor time; figures for which people
wait are wall time. XState needs Node and npm, and the broker needs RabbitMQ; a row without its program reports that.
"""

import argparse
import gc
import os
import platform
import re
import sys
import tempfile
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from statistics import median
from typing import Any, NamedTuple

sys.path.insert(0, str(Path(__file__).parents[1]))

import bus
import lint
import reload
from fuzzy import processor
from peers import xstate
from statechart import regions, ring, sending
from tests.guarded import DEVNULL, PIPE, Guarded
from timing import rate
from visit import tour

import lumen
from lumen.fuzzy.evaluator import Evaluator
from lumen.statechart import Interpreter

ROOT = Path(__file__).parents[1]
EDITS = 45
RUNS = 3
PAIRS = 5
SPOKEN = "robot    “"


class Row(NamedTuple):
    """A figure: its subject, its target, the function that measures it, and how pairs.py compares it.

    `more`: a larger figure is better. `ours`: which of the printed numbers are Lumen's.
    """

    what: str
    wanted: str
    measure: Callable[[], str]
    more: bool = False
    ours: Sequence[int] = (0,)


@cache
def actor() -> dict[str, float]:
    """Return the events per second of XState's `actor.send`, by machine."""
    (rates,) = (rates for name, rates in xstate((15,)) if "actor" in name)
    if isinstance(rates, str):
        raise RuntimeError(rates)
    return rates


def ring_of_15() -> str:
    """Return the rate of a ring of 15 states relative to XState's."""
    return f"{rate(sending(ring(15))) / actor()['15 states']:.2f} x"


def three_levels() -> str:
    """Return the rate of a chart with three levels relative to XState's."""
    return f"{rate(sending(regions())) / actor()['regions']:.2f} x"


def many_states() -> str:
    """Return the ratio of the rates of a large and a small ring, measured in turns because the load varies."""
    many, few = sending(ring(1_500)), sending(ring(15))
    return f"{median(rate(many) / rate(few) for _ in range(PAIRS)):.2f}"


def first_visits() -> str:
    """Return the time to enter each new state of a ring once."""

    def once() -> float:
        interpreter = Interpreter(ring(1_500))
        interpreter.start()
        gc.collect()  # else a collection of everything imported may fall into the measured time
        began = time.process_time()
        for _ in range(1_499):
            interpreter.send("go")
        return (time.process_time() - began) / 1_499

    return f"{1e3 * median(once() for _ in range(RUNS)):.3f} ms"


def built() -> str:
    """Return the times to build and to start a ring of 1,500 states."""

    def once() -> tuple[float, float]:
        gc.collect()
        began = time.process_time()
        machine = ring(1_500)
        there = time.process_time()
        Interpreter(machine).start()
        return there - began, time.process_time() - there

    made, started = zip(*(once() for _ in range(RUNS)), strict=True)
    return f"{1e3 * median(made):.0f} and {1e3 * median(started):.0f} ms"


def visits() -> str:
    """Return the steps per second of visits to the tour."""
    return f"{rate(tour()) / 1e3:.0f} k/s"


@cache
def edits() -> reload.Outcome:
    """Return the outcome of edits during a run, made once."""
    return reload.soak(EDITS)


def verdict() -> str:
    """Return the median time from a saved file to its verdict."""
    return f"{1e3 * median(edits().single):.0f} ms"


def missed() -> str:
    """Return the number of ticks missed during edits."""
    found = edits()
    return f"{found.missed} of {found.ticks:,}; idle {found.beside}"


def first_word(robot: str) -> str:
    """Return the median processor time until a robot's first word."""
    return f"{median(_first_word(robot) for _ in range(RUNS)):.2f} s"


def _first_word(robot: str) -> float:
    """Return the processor time [s] of an exhibition and its child processes until the robot says its first word."""
    with speaking([sys.executable], ROOT, robot, os.environ) as process:
        return sum(_processor_time(pid) for pid in _tree(process.pid))


@contextmanager
def speaking(python: Sequence[str], root: Path, robot: str, environment: Mapping[str, str]) -> Iterator[Guarded[str]]:
    """Start an exhibition with an empty home, and enter the context when the robot has said its first word.

    The process ends with the context. Raises RuntimeError if it ends without a word.
    """
    words = [*python, "-m", "lumen", "run", root, "--story", "visitor", "--robot", robot, "--fresh"]
    with tempfile.TemporaryDirectory() as home:
        own = {**environment, "LUMEN_HOME": home}
        with Guarded(words, stdout=PIPE, stdin=DEVNULL, text=True, env=own) as process:
            assert process.stdout
            if not any(SPOKEN in line for line in process.stdout):
                raise RuntimeError("it ended without a word")
            yield process
            process.terminate()


def _tree(pid: int) -> Iterator[int]:
    """Yield the ids of a process and of its descendants."""
    yield pid
    for children in Path(f"/proc/{pid}/task").glob("*/children"):
        for child in children.read_text().split():
            yield from _tree(int(child))


def _processor_time(pid: int) -> float:
    fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    return sum(map(int, fields[11:13])) / os.sysconf("SC_CLK_TCK")


def cold_lint() -> str:
    """Return the processor times of a cold lint relative to those of the imports."""
    imports, nothing, same, changed = lint.cold()
    each = (
        f"{took / imports:.2f} x {what}" for took, what in ((nothing, "nothing kept"), (changed, "one file changed"))
    )
    return f"{', '.join(each)}; {same / imports:.2f} x the same files"


def toured() -> str:
    """Return the speed of the simulated tour without a camera."""
    import simulation

    project = lumen.load(ROOT)
    robot = simulation.SimulatedRobot(project.body, ROOT / "models", project.hall, stage=project.stage)
    robot.advance(0.02)
    lived, bare = simulation.paced(robot, lambda: simulation.touring(project, robot))
    robot.close()
    return f"{lived:.1f} x real time, {lived / bare:.2f} of bare steps"


def pictured() -> str:
    """Return the speed of the simulated tour with its camera. Raises RuntimeError if no camera can be rendered."""
    import simulation

    if why := simulation.available():
        raise RuntimeError(why)
    project = lumen.load(ROOT)
    robot = simulation.SimulatedRobot(project.body, ROOT / "models", project.hall, stage=project.stage)
    lived, published, dropped = simulation.pictured(project, robot, 4.0)
    return f"{lived:.1f} x real time; {dropped} of {published + dropped} dropped"


def evaluations() -> str:
    """Return how often the controller is evaluated per image while a simulated head turns to a face.

    The first second is left out, and with it the evaluations that only locate the steepest point of the surface.
    """
    from tests.fuzzy import physical_loop

    from lumen.language.stories import Visitor

    evaluate, project = Evaluator.evaluate, lumen.load(ROOT)

    def asked(seconds: float) -> int:
        count = 0

        def counting(*words: Any) -> dict[str, float]:
            nonlocal count
            count += 1
            return evaluate(*words)

        Evaluator.evaluate = counting  # type: ignore[method-assign]
        try:
            physical_loop.run(project, lambda now: Visitor(), (15.0, 8.0), tick=0.1, duration=seconds)
        finally:
            Evaluator.evaluate = evaluate  # type: ignore[method-assign]
        return count

    return f"{(asked(4.0) - asked(1.0)) / 30:.1f}"


def in_process() -> str:
    """Return the messages per second in one process, checked and unchecked."""
    off, on = bus.checks(1.0)
    return f"{on / 1e3:.0f} k/s; unchecked {off / 1e3:.0f}"


def paced() -> str:
    """Return latency and processor time of a steady stream of messages, for Lumen and pika."""
    with bus.broker(None) as url:
        ours, theirs = bus.paced(url, bus.Ours), bus.paced(url, bus.Pikas)
    return f"{ours.p99:.1f} ms, pika {theirs.p99:.1f}; {ours.spent:.0f} us CPU, pika {theirs.spent:.0f}"


def quick() -> str:
    """Return the duration of `make quick` in this checkout and the number of tests that it runs."""
    began = time.monotonic()
    with Guarded(["make", "quick"], cwd=ROOT, stdout=PIPE, stderr=DEVNULL, stdin=DEVNULL, text=True) as process:
        said = process.communicate()[0]
    took = time.monotonic() - began
    if process.returncode:
        raise RuntimeError("a test failed")
    (passed,) = re.findall(r"(\d+) passed", said)
    return f"{took:.0f} s, {int(passed):,} tests"


ROWS = (
    Row("`Interpreter.send`, ring of 15, against XState's `actor.send`", "2.5 x", ring_of_15, more=True),
    Row("the same, three levels and two regions", "4 x", three_levels, more=True),
    Row("1,500 states against 15", "0.95", many_states, more=True),
    Row("first visit to a state", "0.05 ms", first_visits),
    Row("build and start of 1,500 states", "150 and 5 ms", built, ours=(0, 1)),
    Row("steps of visits to the tour", "300 k/s", visits, more=True),
    Row("saved file to verdict, one good file, median", "120 ms", verdict),
    Row("ticks missed while files are edited", "0", missed),
    Row("`lumen run` to the first word, CPU", "1.0 s", lambda: first_word("simulation")),
    Row("the same, `--robot recording`", "0.4 s", lambda: first_word("recording")),
    Row("`lumen lint` cold, against `import yaml, jsonschema`", "2.0 x", cold_lint, ours=(0, 1, 2)),
    Row("whole tour in simulation, no camera, by CPU", "30 x, 0.70", toured, more=True, ours=(0, 1)),
    Row("the same with the camera, by CPU; images dropped at 4 x", "8 x; 0", pictured, more=True),
    Row("fuzzy evaluations for each image while tracking", "2", evaluations),
    Row("one message in this process, checked", "400 k/s", in_process, more=True, ours=(0, 1)),
    Row("RabbitMQ, 200 B at 1,000/s: 99th of 100, CPU a message", "pika's", paced, ours=(0, 2)),
    Row("`make quick`, and how many tests it comes to", "45 s", quick),
)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rows", default="", help="only those whose words contain this")
    parser.add_argument("--markdown", action="store_true", help="as a table of Markdown")
    options = parser.parse_args()
    if not any(options.rows in row.what for row in ROWS):
        parser.error(f"no row contains {options.rows!r}; the rows are:\n" + "\n".join(row.what for row in ROWS))
    load = ", ".join(f"{load:.1f}" for load in os.getloadavg())
    print(f"{processor()}, {os.cpu_count()} cores, Python {platform.python_version()}; load before {load}\n")
    form = "| {} | {} | {} |" if options.markdown else "{:<62}{:<16}{}"
    print(form.format("what", "to be reached", "here"), flush=True)
    if options.markdown:
        print(form.format("---", "---", "---"))
    for row in ROWS:
        if options.rows in row.what:
            print(form.format(row.what, row.wanted, _figure(row)), flush=True)
    return 0


def _figure(row: Row) -> str:
    try:
        return row.measure()
    except (RuntimeError, OSError) as error:
        return f"not measured: {error}"


if __name__ == "__main__":
    sys.exit(main())
