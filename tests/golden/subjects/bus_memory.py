"""The bus of one process in a visit of the tour and one of the museum: calls, and messages as they are received.

Time is virtual; `transcripts` sums up telemetry.
"""

import shutil
from pathlib import Path
from tempfile import TemporaryDirectory

import lumen
from lumen.bus import connect
from tests.golden.golden import PROJECTS
from tests.golden.texts import write
from tests.golden.transcripts import VISITS, Transcript, telemetry_of, write_down

SUITE = "test"


def record(folder: Path) -> None:
    """Write two files for each visit: the calls of the exhibition, and the messages that another handle receives."""
    for name, (_, seconds) in VISITS.items():
        telemetry = telemetry_of(lumen.load(PROJECTS / name))
        calls, received = Transcript(telemetry), Transcript(telemetry)
        with TemporaryDirectory() as temporary:
            root = Path(shutil.copytree(PROJECTS / name, Path(temporary) / name))
            watcher = connect(f"memory://golden-{name}")
            received.now = calls.time
            watcher.subscribe("#", received.receive)
            write_down(root, connect(f"memory://golden-{name}", sender="golden"), calls, seconds)
            watcher.close()
            received.sum_up()
        write(folder / f"{name}_calls.txt", calls.lines)
        write(folder / f"{name}_received.txt", received.lines)
