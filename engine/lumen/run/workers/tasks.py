"""The worker's side: it unpacks the kit of a piece of work once, and does its tasks one after another."""

import pickle
import sys
import tempfile
import threading
from collections.abc import Callable
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any, NamedTuple

from lumen.errors import WorkersError
from lumen.project.engine_files import code_hash
from lumen.project.memoization import memoize
from lumen.run.workers.work_kit import UnpackedKit

PACKAGES = ("lumen-robot", "mujoco", "dm-control", "numpy")
"""Packages on which results depend, besides Python."""

_alone = threading.Lock()
"""A cluster's worker may have several threads, but the simulation's compiler supports only one."""


class TaskHead(NamedTuple):
    """The data that comes with every task."""

    function: Callable[..., Any]
    """Does a task."""
    engine: str
    """Description of the sender's software."""
    kit: str
    """Name of the kit."""
    folder: str = ""
    """Folder for the unpacked kit; empty for the worker's own."""


def do_task(head: TaskHead, packed: bytes | str, task: tuple[Any, ...]) -> Any:
    """Return the function's result for the kit and a task. `packed` is the kit, or the path of its file.

    Raises WorkersError if the sender has other software.
    """
    if head.engine != engine():
        raise WorkersError(
            f"a worker has other software versions than this machine: there {engine()}; here {head.engine}. "
            "Install the same Lumen, Python and packages on both"
        )
    with _alone:
        kit = memoize("work", head.kit, lambda: _unpacked(head, packed))
        return head.function(kit, *task)


def _unpacked(head: TaskHead, packed: bytes | str) -> UnpackedKit:
    kit = Path(packed).read_bytes() if isinstance(packed, str) else packed
    return UnpackedKit(pickle.loads(kit), head.kit, Path(head.folder or _own_folder()))


@cache
def _own_folder() -> str:
    """Return a new folder within that of the cluster's worker, which deletes it at its end."""
    from distributed import get_worker

    return tempfile.mkdtemp(prefix="lumen-", dir=get_worker().local_directory)


@cache
def engine() -> str:
    """Return a description of this software for people, with a hash of Lumen's own code."""
    python = ".".join(map(str, sys.version_info[:2]))
    packages = ", ".join(f"{name} {_version(name)}" for name in PACKAGES)
    return f"Lumen's code {code_hash('lumen')[:8]}, Python {python}, {packages}"


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return "none"
