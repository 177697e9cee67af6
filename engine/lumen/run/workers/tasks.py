"""The kit of a piece of work; and a worker, which unpacks it once and does its tasks one after another."""

import hashlib
import os
import pickle
import shutil
import sys
import tempfile
import threading
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from functools import cache, cached_property
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any, NamedTuple

from lumen.errors import WorkersError
from lumen.language.projects import Project
from lumen.lint import check_files
from lumen.project.engine_files import code_hash
from lumen.project.memoization import memoize
from lumen.project.project_folders import MODELS


@dataclass(frozen=True)
class WorkKit:
    """The files that tasks need; their paths are relative to the project's root."""

    bundles: Mapping[str, Mapping[str, bytes]]
    """The files of each bundle, by the name of the bundle."""
    meshes: Mapping[str, bytes]
    """The files of the models, which the simulation opens itself."""

    def packed(self) -> bytes:
        """Return the kit as bytes, which are the same for the same files anywhere."""
        bundles = {name: dict(sorted(files.items())) for name, files in sorted(self.bundles.items())}
        return pickle.dumps(WorkKit(bundles, dict(sorted(self.meshes.items()))), pickle.HIGHEST_PROTOCOL)


def models_in(root: Path) -> dict[str, bytes]:
    """Return the readable files in the project's `models/`, by their paths relative to its root."""
    found = {}
    for path in sorted((root / MODELS).rglob("*")):
        with suppress(OSError):
            if path.is_file():
                found[path.relative_to(root).as_posix()] = path.read_bytes()
    return found


class UnpackedKit:
    """A kit in a worker, in its own folder below `folder`; a project is loaded on first use."""

    def __init__(self, kit: WorkKit, name: str, folder: Path) -> None:
        self.kit, self._name, self._folder = kit, name, folder
        self._projects: dict[str, Project | None] = {}

    @cached_property
    def root(self) -> Path:
        """The folder with the meshes; it is created complete, in one step."""
        root = self._folder / self._name
        if not root.exists():
            draft = Path(tempfile.mkdtemp(dir=self._folder))
            for file, content in self.kit.meshes.items():
                (draft / file).parent.mkdir(parents=True, exist_ok=True)
                (draft / file).write_bytes(content)
            try:
                os.rename(draft, root)
            except OSError:  # another worker was faster
                shutil.rmtree(draft, ignore_errors=True)
        return root

    def project(self, bundle: str = "") -> Project | None:
        """Return the project of a bundle; None if its files have errors or no bundle has that name."""
        if bundle not in self._projects:
            files = self.kit.bundles.get(bundle)
            self._projects[bundle] = check_files(self.root, files)[0] if files else None
        return self._projects[bundle]


def name_of(packed: bytes) -> str:
    """Return the hash of a packed kit, which is its name."""
    return hashlib.sha256(packed).hexdigest()[:32]


PACKAGES = ("lumen-robot", "mujoco", "dm-control", "numpy")
"""The packages on which results depend, besides Python."""

_alone = threading.Lock()
"""Held while a task runs: a cluster's worker may have several threads, but the simulation's compiler supports one."""


class TaskHead(NamedTuple):
    """The data that comes with every task."""

    function: Callable[..., Any]
    """The function that performs a task."""
    engine: str
    """A description of the sender's software."""
    kit: str
    """The name of the kit."""
    folder: str = ""
    """The folder for the unpacked kit; empty for the worker's own."""


def do_task(head: TaskHead, packed: bytes | str, task: tuple[Any, ...]) -> Any:
    """Return the result of the function for the kit and a task.

    `packed` is the packed kit, or the path of its file. Raises WorkersError if the sender has other software.
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
    """Return a new folder inside the folder of the cluster's worker, which deletes it when the worker ends."""
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
