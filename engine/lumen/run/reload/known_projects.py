"""Projects whose files were checked before, byte for byte and by this very engine, so that they are not checked again.

The user's cache has the delta that the checking process sent (run/reload/delta.py), so a start with unchanged files
needs no process to read them. Only projects without errors are stored, and without their warnings.
"""

import hashlib
import pickle
import sys
import zlib
from collections.abc import Mapping
from pathlib import Path

from lumen.language.projects import Project
from lumen.project.chosen_robot import chosen_robot
from lumen.project.engine_files import engine, listed
from lumen.project.files import fingerprint
from lumen.project.project_folders import MODELS
from lumen.run.reload.delta import Delta, DeltaDecoder
from lumen.upkeep.own_folders import CacheFolder

_LEVEL = 1
"""The compression level of zlib: the fastest."""


def recall(root: Path, files: Mapping[str, bytes]) -> Project | None:
    """Return the project of these files; None if the cache does not have it, or can't be read."""
    packed = CacheFolder("projects").read(_name(root, files))
    if packed is None:
        return None
    try:
        project: Project = DeltaDecoder().unpack(pickle.loads(zlib.decompress(packed)))
        return project.at(str(root.absolute()))
    except Exception:  # the file may contain anything: then the project is made again
        return None


def keep(root: Path, files: Mapping[str, bytes], packed: Delta) -> None:
    """Store the packed project of these files."""
    content = zlib.compress(pickle.dumps(packed, pickle.HIGHEST_PROTOCOL), _LEVEL)
    CacheFolder("projects").write(_name(root, files), content)


def _name(root: Path, files: Mapping[str, bytes]) -> str:
    """Return the name of the cache entry: a hash of everything on which the project depends.

    Of models that were not read, only the listing counts.
    """
    digest = hashlib.sha256(f"{fingerprint(files)} {chosen_robot(files)} {engine()} {sys.version}".encode())
    for path, what, _ in sorted(listed(root / MODELS)):
        if f"{MODELS}/{path}" not in files:
            digest.update(f"{path} {what}\n".encode("utf-8", "surrogateescape"))
    return digest.hexdigest()
