"""A Dask cluster, run by others, as an executor."""

import logging
import socket
import warnings
from collections.abc import Iterator
from concurrent.futures import CancelledError, Executor
from contextlib import contextmanager
from importlib import import_module
from typing import Any

from lumen.errors import UsageError, WorkersError
from lumen.extras import demand

SCHEME = "dask://"
PACKAGE_NAME = "lumen-robot"
ANSWER_TIMEOUT = 10.0
"""The longest wait for the scheduler's answer [s]."""


def cluster_address(text: str) -> str:
    """Return `tcp://HOST:PORT` for `dask://HOST:PORT`.

    Raises UsageError for any other text, or if the extra is not installed.
    """
    host, _, port = text.removeprefix(SCHEME).rpartition(":")
    if not host or not port.isdecimal() or not 0 < int(port[:6]) < 65536:
        raise UsageError(f"`{text[:80]}` is not the address of a cluster: write it as dask://HOST:8786")
    demand("cluster", f"--workers {SCHEME}…", "distributed")
    return f"tcp://{host}:{port}"


@contextmanager
def cluster(address: str, packed: bytes) -> Iterator[tuple[Executor, Any]]:
    """Connect to a cluster; yield its executor, and a handle to pass to tasks in place of `packed`.

    Raises WorkersError if no scheduler answers, the cluster has no workers, or Lumen is missing on one of them;
    CancelledError if the scheduler is lost during the work.
    """
    distributed: Any = import_module("distributed")
    shown = address.replace("tcp://", SCHEME)
    logging.getLogger("distributed").setLevel(logging.CRITICAL)  # errors are reported in Lumen's own words
    warnings.filterwarnings("ignore", module="distributed")
    host, _, port = address.removeprefix("tcp://").rpartition(":")
    try:
        socket.create_connection((host.strip("[]"), int(port)), ANSWER_TIMEOUT).close()  # Dask would retry for long
        client = distributed.Client(address, timeout=ANSWER_TIMEOUT, set_as_default=False)
    except (OSError, ValueError) as error:
        raise WorkersError(
            f"no Dask scheduler answers at {shown}: start one there with `dask scheduler`, and workers with "
            f"`dask worker {address}`"
        ) from error
    try:
        seen = client.get_versions(packages=[PACKAGE_NAME])["workers"]
        if not seen:
            raise WorkersError(f"the scheduler at {shown} has no workers: start some with `dask worker {address}`")
        if bare := [name for name, found in seen.items() if not found["packages"].get(PACKAGE_NAME)]:
            raise WorkersError(
                f"Lumen is not installed on the machine of the worker {bare[0]}: install the same version there"
            )
        yield client.get_executor(pure=False), client.submit(bytes, packed)
    except OSError as error:  # the scheduler is gone
        raise CancelledError(str(error)) from error
    finally:
        client.close(timeout=ANSWER_TIMEOUT)


def lost_in_cluster() -> tuple[type[BaseException], ...]:
    """Return the errors of a task whose workers were lost, or that the cluster has forgotten."""
    from distributed import KilledWorker

    return KilledWorker, CancelledError
