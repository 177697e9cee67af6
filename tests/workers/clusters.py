"""A cluster of Dask on this machine: a scheduler and workers, each a process that ends with the tests."""

import os
import sys
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

from tests import ROOT
from tests.guarded import DEVNULL, Guarded
from tests.waiting import HANG, until


@contextmanager
def dask_cluster(folder: Path, workers: int) -> Iterator[str]:
    """Yield the address of a scheduler with so many workers, in the form of `--workers`; `folder` has their files."""
    from distributed import Client

    file = folder / "scheduler.json"
    quiet = {"cwd": folder, "env": {**os.environ, "PYTHONPATH": str(ROOT)}, "stdout": DEVNULL, "stderr": DEVNULL}
    with ExitStack() as started:

        def start(kind: str, *words: str) -> None:
            command = [sys.executable, "-m", f"distributed.cli.dask_{kind}", "--scheduler-file", str(file), *words]
            process = started.enter_context(Guarded(command, **quiet))
            started.callback(process.kill)

        start("scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard")
        until(file.exists, HANG)
        for number in range(workers):
            start(
                "worker",
                "--no-nanny",
                "--nthreads",
                "1",
                "--no-dashboard",
                "--local-directory",
                str(folder / f"{number}"),
            )
        with Client(scheduler_file=str(file), set_as_default=False) as client:
            if workers:
                client.wait_for_workers(workers, HANG)
            address = client.scheduler.address
        yield address.replace("tcp://", "dask://")
