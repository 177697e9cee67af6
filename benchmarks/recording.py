"""Measure the cost of recording a running tour: CPU time, size on the disk, and the latest tick.

    python benchmarks/recording.py [--robot recording|simulation] [--seconds S] [--rounds N]

The shipped tour runs with its visitor in real time: in turn without a recording, with one without images, and with a
complete one. The delay of a tick is the time since the 50th of a second at which it was due; the table has the
greatest delay of the median round. On a busy machine, these delays are upper bounds. CPU time is that of the whole
process, so the cost of a recording is the difference between two rows. With images it includes drawing and encoding
them, which Lumen does only for subscribers.
"""

import argparse
import platform
import shutil
import statistics
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

import lumen
from lumen.features.mcap.files.reading import read_recording
from lumen.features.mcap.files.recorded import RecordedMessage
from lumen.language.retention import RecordingSettings
from lumen.run.exhibition import Exhibition
from lumen.run.loop import TICK_PERIOD
from lumen.run.plan import Plan
from lumen.run.recovery.run_directory import RunDirectory
from lumen.run.setup import set_up

ROOT = Path(__file__).parents[1]
SETTLED = 3.0
"""Time after which the files and the robot's appearance have been written [s]."""
KINDS = {"no recording": None, "without the camera": False, "with the camera": True}


class Round(NamedTuple):
    """CPU time per second [s], bytes and messages per second, and the greatest delay of a tick [s]."""

    cpu: float
    bytes: float
    messages: float
    late: float


def live(robot: str, camera: bool | None, seconds: float) -> Round:
    """Run the tour for `seconds`; return its measurements. A `camera` of None means that nothing is recorded."""
    folder = Path(tempfile.mkdtemp())
    try:
        project = lumen.load(ROOT)
        project = project.with_section("record", RecordingSettings(camera=bool(camera)))
        story = project.stories["visitor"]
        path = folder / "tour.mcap"
        setup, directory = set_up(robot, project, "1", story), RunDirectory(folder)
        late, first = 0.0, 0
        with Exhibition(
            Plan(
                project,
                setup,
                story=story,
                options={"directory": directory, "record": None if camera is None else path},
            )
        ) as exhibition:
            exhibition.start()
            cpu, began, before = time.process_time(), time.monotonic(), time.monotonic()
            while time.monotonic() - began < seconds and not exhibition.over:
                exhibition.tick()
                now = time.monotonic()
                late, before = max(late, now - before - TICK_PERIOD), now
                if not first and now - began > SETTLED and path.exists():
                    first = path.stat().st_size  # data written once is not counted
            took, cpu = time.monotonic() - began, time.process_time() - cpu
            size = path.stat().st_size - first if path.exists() else 0
        directory.close(forget=True)
        items = [] if camera is None else [item for item in read_recording(path) if isinstance(item, RecordedMessage)]
        return Round(cpu / took, size / (took - SETTLED), len(items) / took, late)
    finally:
        shutil.rmtree(folder)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--robot", choices=("recording", "simulation"), default="simulation")
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--rounds", type=int, default=3)
    asked = parser.parse_args()
    print(
        f"Python {platform.python_version()}, the {asked.robot} robot, {asked.rounds} rounds of {asked.seconds:g} s\n"
    )
    rounds: dict[str, list[Round]] = {kind: [] for kind in KINDS}
    for _ in range(asked.rounds):
        for kind, camera in KINDS.items():
            rounds[kind].append(live(asked.robot, camera, asked.seconds))
    print(f"{'':20} {'CPU of a core':>14} {'messages/s':>11} {'MB an hour':>11} {'latest tick':>12}")
    for kind, found in rounds.items():
        cpu, size, messages, late = (statistics.median(column) for column in zip(*found, strict=True))
        print(f"{kind:20} {cpu:>13.1%} {messages:>11.0f} {size * 3600 / 1e6:>11.0f} {late * 1000:>9.1f} ms")


if __name__ == "__main__":
    main()
