"""A cluster of Dask, which somebody else runs, as an executor."""

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
"""How long a scheduler may take to answer [s]."""


def cluster_address(text: str) -> str:
    """`tcp://HOST:PORT` of `dask://HOST:PORT`. Raises UsageError, also where the extra is not installed."""
    host, _, port = text.removeprefix(SCHEME).rpartition(":")
    if not host or not port.isdecimal() or not 0 < int(port[:6]) < 65536:
        raise UsageError(f"`{text[:80]}` is not the address of a cluster: write it as dask://HOST:8786")
    demand("cluster", f"--workers {SCHEME}…", "distributed")
    return f"tcp://{host}:{port}"


@contextmanager
def cluster(address: str, packed: bytes) -> Iterator[tuple[Executor, Any]]:
    """The cluster as an executor, and what stands for `packed` among the arguments of a task.

    Raises WorkersError where nobody answers, or no worker is there.
    """
    distributed: Any = import_module("distributed")
    shown = address.replace("tcp://", SCHEME)
    logging.getLogger("distributed").setLevel(logging.CRITICAL)  # what goes wrong is said in our words
    warnings.filterwarnings("ignore", module="distributed")
    host, _, port = address.removeprefix("tcp://").rpartition(":")
    try:
        socket.create_connection((host.strip("[]"), int(port)), ANSWER_TIMEOUT).close()  # Dask would go on trying
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
    """What a task raises that no worker could do, or that the cluster has forgotten."""
    from distributed import KilledWorker

    return KilledWorker, CancelledError
