"""What all tasks of one piece of work need: files, sent to each worker once and loaded there once."""

import hashlib
import os
import pickle
import shutil
import tempfile
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from lumen.language.projects import Project
from lumen.lint import check_files
from lumen.project.project_folders import MODELS


@dataclass(frozen=True)
class WorkKit:
    """The files of one or more `bundles`, by a name for each; and the `meshes`, which the simulation opens by itself.

    The paths of both begin at the project's root.
    """

    bundles: Mapping[str, Mapping[str, bytes]]
    meshes: Mapping[str, bytes]

    def packed(self) -> bytes:
        """As it travels: the same bytes for the same files, wherever they are."""
        bundles = {name: dict(sorted(files.items())) for name, files in sorted(self.bundles.items())}
        return pickle.dumps(WorkKit(bundles, dict(sorted(self.meshes.items()))), pickle.HIGHEST_PROTOCOL)


def models_in(root: Path) -> dict[str, bytes]:
    """The files in the project's `models/`, by their path from its root; one that can't be read is left out."""
    found = {}
    for path in sorted((root / MODELS).rglob("*")):
        with suppress(OSError):
            if path.is_file():
                found[path.relative_to(root).as_posix()] = path.read_bytes()
    return found


class UnpackedKit:
    """A kit where a worker has it, in a folder of its own below `folder`; a project is loaded when a task asks."""

    def __init__(self, kit: WorkKit, name: str, folder: Path) -> None:
        self.kit, self._name, self._folder = kit, name, folder
        self._projects: dict[str, Project | None] = {}

    @cached_property
    def root(self) -> Path:
        """The folder with the meshes; it is there whole, or not at all."""
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
        """The project of that bundle, None where its files have errors, or there is none of that name."""
        if bundle not in self._projects:
            files = self.kit.bundles.get(bundle)
            self._projects[bundle] = check_files(self.root, files)[0] if files else None
        return self._projects[bundle]


def name_of(packed: bytes) -> str:
    """The hash of a kit as it travels."""
    return hashlib.sha256(packed).hexdigest()[:32]
