"""The files of a proved bundle, brought into the project's folder as a whole: a crash between is made good."""

import os
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

from lumen.app.fleet.kept_bundles import BundleFolder
from lumen.app.fleet.memory import AgentMemory, keep, memory_file, remember
from lumen.loading.files import FLEET_FILE, read_files
from lumen.runtime.home import Home, home_of

FOLDER = "fleet"


def bundle_folder(root: Path) -> BundleFolder:
    """Where the robots of a project keep bundles."""
    return BundleFolder(home_of(root) / FOLDER)


def install(root: Path, files: Mapping[str, bytes]) -> Mapping[str, bytes]:
    """Make the project's files these; those that lie there then. Links and fleet.yaml stay as they are."""
    there = read_files(root)
    for path, content in files.items():
        if path != FLEET_FILE and there.get(path) != content:
            _write(root / path, content)
    for path in {*there} - {*files, FLEET_FILE}:
        with suppress(OSError):
            (root / path).unlink()
    return read_files(root)


def finish(root: Path) -> None:
    """Bring files into the project's folder that were on their way there when the process ended."""
    home = Home(home_of(root))
    for file in sorted(home.folder.glob(memory_file("*"))):
        robot = file.name.removeprefix("fleet-").removesuffix(".json")
        memory = remember(home, robot)
        if memory.writing and (files := bundle_folder(root).files(memory.writing)) is not None:
            install(root, files)
        if memory.writing:
            written(home, robot, memory)


def written(home: Home, robot: str, memory: AgentMemory) -> None:
    """The files are where they belong."""
    memory.writing = ""
    keep(home, robot, memory)


def _write(path: Path, content: bytes) -> None:
    """As a whole or not at all; what can't be written is noticed by who reads the files then."""
    draft = path.with_name(f".{path.name}.new")
    with suppress(OSError):
        path.parent.mkdir(parents=True, exist_ok=True)
        with open(draft, "wb") as opened:
            opened.write(content)
            opened.flush()
            os.fsync(opened.fileno())
        os.replace(draft, path)
