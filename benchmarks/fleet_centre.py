"""Measure a centre with many robots: bytes of a digest and an order, processor time of each, and of a rollout.

    python benchmarks/fleet_centre.py --robots 20,200,10000

A centre on a bus in this process receives presence messages in the form in which robots send them; there is no
broker. A house has ten robots.
"""

import argparse
import json
import tempfile
import time
from pathlib import Path

from lumen.bus.memory import MemoryBus
from lumen.features.fleet.centre import Centre
from lumen.features.fleet.centre_journal import CentreJournal
from lumen.features.fleet.fleet_log import FleetLog
from lumen.features.fleet.installing import BundleFolder
from lumen.features.fleet.rollouts.presence import RobotPresence
from lumen.features.fleet.rollouts.rollout import begin
from lumen.features.fleet.rollouts.state import CentreState
from lumen.features.fleet.settings import Fleet, FleetHouse, FleetMeasure, RolloutPlan, StepTarget
from lumen.features.fleet.signing import Signer, generate
from lumen.language.fleet_keys import desired_key, presence_key
from lumen.project.home import Home

HOUSE = 10
PERIOD = 10.0
OLD, NEW = "a" * 64, "b" * 64
MEASURES = {name: FleetMeasure(name) for name in ("falls", "errors", "visits")}


def measured(count: int, folder: Path) -> dict[str, float]:
    """Return figures of a fleet of that many robots, in a rollout to a tenth of them and then to all."""
    houses = max(1, count // HOUSE)
    rows = {f"h{i}": FleetHouse("amqps://x/", tuple(f"nao{j}" for j in range(HOUSE))) for i in range(houses)}
    plan = RolloutPlan((StepTarget(share=0.1), StepTarget(share=1.0)), 20.0, "falls > 0 || errors > 1.5 * before")
    fleet = Fleet("amqps://c/", houses=rows, measures=MEASURES, rollout=plan)
    generate(folder / f"key{count}")
    bus, now = MemoryBus(), [1_000_000.0]
    sizes: list[int] = []
    bus.subscribe(desired_key("h0"), lambda message: sizes.append(len(json.dumps(message.body))))
    log = FleetLog(Home(folder / f"{count}-log"))
    journal = CentreJournal(folder / str(count))
    signer = Signer(folder / f"key{count}")
    bundles = BundleFolder(folder / f"{count}/bundles")
    centre = Centre(fleet, CentreState("one"), journal, bundles, signer, bus, log, clock=lambda: now[0])
    digest = 0
    centre.change(begin(centre.state, fleet, NEW, plan, now[0]), "begins")
    began, looks = time.process_time(), 0
    while not (centre.state.rollout and centre.state.rollout.state == "finished"):
        for name in fleet.robots:
            bundle = centre.state.wanted.get(name, OLD)
            counts = {"hours": 12.5, "falls": 0.0, "errors": 3.0, "visits": 120.0}
            said = RobotPresence(
                name, bundle, "proved", bundle, "", "", "one", 1, centre.state.version, counts, counts, now[0], now[0]
            ).to_json()
            digest = digest or len(json.dumps(said))
            bus.publish(presence_key(*name.split("/")), said)
        for _ in range(int(PERIOD)):
            now[0] += 1.0
            centre.tick()
        looks += 1
    spent = time.process_time() - began
    return {
        "robots": HOUSE * houses,
        "bytes a digest": digest,
        "digests a second": HOUSE * houses / PERIOD,
        "kB/s up": HOUSE * houses * digest / PERIOD / 1e3,
        "bytes an order": max(sizes),
        "kB/s down": houses * max(sizes) / PERIOD / 1e3,
        "% of a core": 100.0 * spent / (looks * PERIOD),
        "kB of journal a rollout": journal.file.stat().st_size / 1e3,
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--robots", default="20,200,2000,10000", help="fleets of so many, by commas")
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        rows = [measured(int(count), Path(folder)) for count in options.robots.split(",")]
    for name in rows[0]:
        print(f"{name:26}" + "".join(f"{row[name]:12,.1f}" for row in rows))


if __name__ == "__main__":
    main()
