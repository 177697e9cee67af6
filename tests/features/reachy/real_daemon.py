"""The daemon of `reachy-mini` without a robot: `--mockup-sim` reaches targets at once, `--sim` has physics."""

import fcntl
import os
import socket
import sys
from functools import cache
from pathlib import Path

import pytest

from lumen.errors import RobotError
from lumen.features.reachy.daemon_api import DaemonAddress, DaemonApi
from tests import ROOT
from tests.environment import downloading
from tests.guarded import STDOUT, Guarded, run_guarded
from tests.waiting import until

PROGRAM = ROOT / ".cache/reachy_mini/bin/reachy-mini-daemon"
MISSING = ROOT / ".cache/reachy_mini.missing"
"""The file with the reason why the daemon could not be installed."""


@cache
def program() -> Path:
    """Return the daemon's program, installed at the first call; skip the test if it can't be installed."""
    script = ROOT / "tests/features/reachy/install_daemon.sh"
    MISSING.parent.mkdir(exist_ok=True)
    with MISSING.with_suffix(".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)  # another run of the tests may be installing it
        if MISSING.exists():
            pytest.skip(f"{MISSING.read_text().strip()} (delete {MISSING.relative_to(ROOT)} to try again)")
        environment = {**downloading(), "PYTHON": sys.executable}
        done = run_guarded(["sh", script], capture_output=True, text=True, env=environment)
    if done.returncode:
        pytest.skip(MISSING.read_text().strip() if MISSING.exists() else done.stderr[-200:])
    return PROGRAM


class RealDaemon:
    """A daemon at `url`, which runs and sleeps."""

    def __init__(self, folder: Path, kind: str = "--mockup-sim", port: int = 0) -> None:
        self.port, self._kind, self._folder = port or _free_port(), kind, folder
        self.url = f"http://127.0.0.1:{self.port}"
        self.api = DaemonApi(DaemonAddress(self.url))
        self.log = folder / f"daemon-{self.port}.log"
        self.start()

    def start(self) -> None:
        """Start the process and wait until it runs."""
        options = ["--no-media", "--no-wake-up-on-start", "--no-preload-datasets", "--fastapi-host", "127.0.0.1"]
        environment = {**os.environ, "DO_NOT_TRACK": "1", "HF_HUB_OFFLINE": "1", "HOME": str(self._folder)}
        for name in ("PYTHONPATH", "LD_PRELOAD"):
            environment.pop(name, None)
        headless = ["--headless"] if self._kind == "--sim" else []
        with self.log.open("ab") as log:
            self.process = Guarded(
                [program(), self._kind, *headless, *options, "--fastapi-port", self.port],
                env=environment,
                stdout=log,
                stderr=STDOUT,
            )
        until(self._runs, what="the daemon runs", every=0.2, shown=lambda: self.log.read_text()[-2000:])

    def kill(self) -> None:
        self.process.kill()
        self.process.wait()

    def close(self) -> None:
        self.kill()
        self.api.close()

    def _runs(self) -> bool:
        assert self.process.poll() is None, self.log.read_text()[-2000:]
        try:
            state = self.api.request("GET", "/api/daemon/status")["state"]
            assert state != "error", self.log.read_text()[-2000:]
            return bool(state == "running" and self.api.request("GET", "/api/state/full"))
        except RobotError:
            return False


def _free_port() -> int:
    with socket.socket() as one:
        one.bind(("127.0.0.1", 0))
        return int(one.getsockname()[1])
