"""Measure the cost of one house's robots in one process, in real time: `python benchmarks/fleet.py --robots 1,5,10,20`.

Recording robots with the behaviour of the small example and the senses of `lumen.yaml` wait for a visitor. For each
number of robots, the table has the messages and bytes per second on the bus, the processor time as a share of a core,
the memory for each robot that no other process shares (PSS), and the ticks that came more than a tick after the
longest nap. `--silent` leaves the senses out, and shows the cost of an idle robot without them. A line through these
figures is extended to 200 robots. It does not include the cost of saved files, journals and recordings.
"""

import argparse
import json
import re
import shutil
import sys
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1]))

import numpy as np
from tests.guarded import run_guarded

import lumen
from lumen.language.events import Event
from lumen.ports import Message
from lumen.run.exhibition import Exhibition
from lumen.run.house import House
from lumen.run.loop import TICK_PERIOD
from lumen.run.node import NAP
from lumen.run.parts.part import Part
from lumen.run.plan import Plan
from lumen.run.setup import set_up_house

ROOT = Path(__file__).parents[1]
SENSES = ("joint", "sonar", "tactile", "battery")
GREATEST = 200


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--robots", default="1,5,10,20")
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--silent", action="store_true", help="without the declared senses")
    parser.add_argument("--one", type=int, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.one:
        print(json.dumps(measured(options.one, options.seconds, silent=options.silent)))
        return
    rows = []
    for number in map(int, options.robots.split(",")):
        command = [sys.executable, __file__, "--one", str(number), "--seconds", str(options.seconds)]
        command += ["--silent"] if options.silent else []
        row = json.loads(run_guarded(command, check=True, capture_output=True, text=True).stdout.splitlines()[-1])
        rows.append(row)
        print(
            f"{number:3} robots: {row['messages']:7.0f} messages/s {row['bytes'] / 1000:8.1f} kB/s"
            f" {row['cpu']:6.1%} of a core ({row['cpu'] / number:.2%} each) {row['pss'] / number:6.1f} MB each"
            f"  {row['late']} of {row['ticks']} ticks late",
            flush=True,
        )
    if len(rows) > 1:
        slope, base = np.polyfit([row["robots"] for row in rows], [row["cpu"] for row in rows], 1)
        print(
            f"{GREATEST} robots would take {base + slope * GREATEST:.1f} cores ({slope:.2%} each, {base:.1%} besides)"
        )


class TickPart(Part):
    """Calls a function in each tick with the time of the tick [s]."""

    patient = True

    def __init__(self, ticked: Callable[[float], None]) -> None:
        self._ticked = ticked

    def tick(self, now: float, changes: Sequence[Event]) -> None:
        """Call the function."""
        self._ticked(now)


def measured(number: int, seconds: float, *, silent: bool = False) -> dict[str, float]:
    """Return the resources that this number of robots uses in this process."""
    with tempfile.TemporaryDirectory() as folder:
        root = project(Path(folder) / "house", number, silent=silent)
        before = pss()
        projects = {name: lumen.load(root, robot=name) for name in (f"r{i}" for i in range(number))}
        setups = set_up_house("recording", projects, "1", dict.fromkeys(projects))
        shows = {name: Exhibition(Plan(projects[name], setups[name], "memory://house")) for name in projects}
        house = House({name: show.services for name, show in shows.items()})
        count = {"messages": 0, "bytes": 0}
        bus = lumen.bus.connect("memory://house")
        house.start()
        house.run(1.0)

        def hear(message: Message) -> None:
            count["messages"] += 1
            count["bytes"] += len(json.dumps(message.body))

        undo = bus.subscribe("#", hear)  # counted separately: its cost is not that of the robots
        house.run(2.0)
        undo()
        rate = {name: value / 2.0 for name, value in count.items()}
        late, ticks, began, cpu = 0, 0, time.monotonic(), time.process_time()
        last = began

        def ticked(_: float) -> None:
            nonlocal late, ticks, last
            now = time.monotonic()
            late, ticks, last = late + (now - last > NAP + TICK_PERIOD), ticks + 1, now

        next(iter(shows.values())).node.parts.append(TickPart(ticked))
        house.run(seconds)
        cpu = (time.process_time() - cpu) / (time.monotonic() - began)
        memory = pss() - before
        house.close()
        bus.close()
    return {"robots": number, "cpu": cpu, "pss": memory, "late": late, "ticks": ticks, **rate}


def project(root: Path, number: int, *, silent: bool) -> Path:
    """Write the small example with that many robots, and with the shipped project's senses unless `silent`."""
    shutil.copytree(ROOT / "examples/minimal", root, ignore=shutil.ignore_patterns(".lumen"))
    robots = "".join(f"\n  r{i}: {{model: nao}}" for i in range(number))
    text = (root / "lumen.yaml").read_text("utf-8").replace("robot: {name: NAO, model: nao}", f"robots:{robots}")
    rows = (
        []
        if silent
        else re.findall(rf"^  (?:{'|'.join(SENSES)}): .*\n", (ROOT / "lumen.yaml").read_text("utf-8"), re.MULTILINE)
    )
    (root / "lumen.yaml").write_text(text.rstrip("\n") + "\n" + "".join(rows), "utf-8")
    return root


def pss() -> float:
    """Return the memory of this process, with shared memory divided among its users [MB]."""
    said = re.search(r"^Pss:\s+(\d+)", Path("/proc/self/smaps_rollup").read_text(), re.MULTILINE)
    return int(said[1]) / 1024 if said else 0.0


if __name__ == "__main__":
    main()
