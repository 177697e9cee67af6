"""What a worker does: it unpacks the kit of a piece of work once, and does one task after another with it."""

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
"""What outcomes depend on, beside Python."""

_alone = threading.Lock()
"""A worker of a cluster may have several threads; the simulation's compiler is made for one."""


class TaskHead(NamedTuple):
    """What comes with every task: the `function`, by which `engine` it was sent, and the name of the kit.

    `folder` is where the kit is unpacked; empty for the worker's own.
    """

    function: Callable[..., Any]
    engine: str
    kit: str
    folder: str = ""


def do_task(head: TaskHead, packed: bytes | str, task: tuple[Any, ...]) -> Any:
    """What the function makes of the kit and this task. `packed` is the kit, or the file that it stands in.

    Raises WorkersError where another engine sent it.
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
    """A folder in that of the cluster's worker, who deletes it when it ends."""
    from distributed import get_worker

    return tempfile.mkdtemp(prefix="lumen-", dir=get_worker().local_directory)


@cache
def engine() -> str:
    """Which software this is, for people, with a hash of Lumen's own code."""
    python = ".".join(map(str, sys.version_info[:2]))
    packages = ", ".join(f"{name} {_version(name)}" for name in PACKAGES)
    return f"Lumen's code {code_hash('lumen')[:8]}, Python {python}, {packages}"


def _version(package: str) -> str:
    try:
        return version(package)
    except PackageNotFoundError:
        return "none"
