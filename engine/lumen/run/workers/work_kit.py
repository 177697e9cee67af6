"""The files that all tasks of a piece of work need, sent to each worker and loaded there only once."""

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
    """The files of one or more `bundles`, by name, and the `meshes`, which the simulation opens itself.

    The paths of both are relative to the project's root.
    """

    bundles: Mapping[str, Mapping[str, bytes]]
    meshes: Mapping[str, bytes]

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
        """Return the project of a bundle, None if its files have errors or there is no such bundle."""
        if bundle not in self._projects:
            files = self.kit.bundles.get(bundle)
            self._projects[bundle] = check_files(self.root, files)[0] if files else None
        return self._projects[bundle]


def name_of(packed: bytes) -> str:
    """Return the hash of a packed kit, which is its name."""
    return hashlib.sha256(packed).hexdigest()[:32]
