"""Tasks for the workers of tests: in a module, as all tasks must be."""

import os
import signal
import time
from pathlib import Path

from lumen.features.simulation.settings import Imperfections
from lumen.features.simulation.trials.playing import play_case
from lumen.features.simulation.trials.trial import Outcome
from lumen.run.workers.tasks import UnpackedKit


def square(kit: UnpackedKit, number: int) -> tuple[int, bytes]:
    return number**2, (kit.root / "models" / "mesh.stl").read_bytes()


def process(kit: UnpackedKit, number: int) -> int:
    return os.getpid()


def of_sigterm(kit: UnpackedKit, number: int) -> bool:
    """Return whether SIGTERM ends this process at once."""
    return signal.getsignal(signal.SIGTERM) is signal.SIG_DFL


def die(kit: UnpackedKit, number: int) -> None:
    os.kill(os.getpid(), signal.SIGKILL)


def square_or_die(kit: UnpackedKit, number: int, marker: str) -> int:
    """Return the square of the number; the worker that does the third task first is killed by it."""
    if number == 3:
        die_once(marker)
    return number**2


def play_or_die(kit: UnpackedKit, case: int, robot: int, lacking: Imperfections, marker: str) -> Outcome:
    if robot == 1:
        die_once(marker)
    return play_case(kit, case, robot, lacking)


def die_once(marker: str) -> None:
    if not Path(marker).exists():
        Path(marker).touch()
        os.kill(os.getpid(), signal.SIGKILL)


def wait_for_ever(kit: UnpackedKit, number: int, folder: str) -> None:
    Path(folder, f"began-{number}").touch()
    while True:
        time.sleep(1000)
