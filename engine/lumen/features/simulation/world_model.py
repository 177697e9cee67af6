"""The robot in its hall as a MuJoCo model, compiled once for the same files and kept on disk."""

import copy
import hashlib
import os
import zlib
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np

from lumen.features.simulation.model_terms import Variation
from lumen.features.simulation.physics import Physics, dm_control, mujoco, wrapper
from lumen.language.robots import Body
from lumen.project.engine_files import files_hash
from lumen.project.memoization import memoize
from lumen.upkeep.own_folders import CacheFolder

KEPT = 16
"""The maximum number of compiled worlds kept on disk, of about 3 MB each."""
MAX_BYTES = 32_000_000
"""The maximum total size of a world's files for which the compiled world is kept [bytes].

Reading larger files at each start would take too long.
"""
BINARY = "world.mjb"
_LEVEL = 1


def physics(
    body: Body, models: Path, hall: str, variation: Variation | None = None, *, backlash: bool = False
) -> Physics:
    """Return the hall with the robot on its stage, ready to be simulated.

    A later robot with the same body, files and variation gets a copy of the first robot's compiled model. Models
    without a variation are also kept on disk for later processes. Raises RobotError as `model.load` does, or if MuJoCo
    can't build the world.
    """
    folders = {models, (models / hall).parent}
    files = {path: _version(path) for folder in folders for path in _files(folder)}

    def compiled() -> mujoco.MjModel:
        from lumen.features.simulation.model import compile_world, load

        return compile_world(load(body, models, hall, variation, backlash=backlash))

    def made() -> mujoco.MjModel:
        if variation or sum(size for _, size, _ in files.values()) > MAX_BYTES:
            return compiled()
        description = body, body.roles.base.row, Path(hall).name, backlash, mujoco.__version__, _engine()
        digest = hashlib.sha256(repr(description).encode())
        for path in sorted(files):
            digest.update(f"{os.path.relpath(path, models)} {files[path][1]} ".encode("utf-8", "surrogatepass"))
            digest.update(path.read_bytes())
        return _kept(digest.hexdigest(), compiled)

    found = memoize(("simulation", hall, backlash), (body, files, variation), made)
    return Physics.from_model(wrapper.MjModel(copy.copy(found)))


def _kept(name: str, compiled: Callable[[], mujoco.MjModel]) -> mujoco.MjModel:
    """Return the model kept under this name; if it is missing or damaged, compile and keep it."""
    folder = CacheFolder("worlds", KEPT)
    if packed := folder.read(name):
        try:
            return mujoco.MjModel.from_binary_path(BINARY, {BINARY: zlib.decompress(packed)})
        except (ValueError, zlib.error):  # A damaged file is compiled again.
            pass
    made = compiled()
    content = np.zeros(mujoco.mj_sizeModel(made), np.uint8)
    mujoco.mj_saveModel(made, None, content)
    folder.write(name, zlib.compress(content.tobytes(), _LEVEL))
    return made


@cache
def _engine() -> str:
    """Return a hash of the code that builds worlds: an edit or another dm_control invalidates kept worlds."""
    return files_hash(Path(__file__).parent, Path(dm_control.__path__[0]))


def _files(folder: Path) -> list[Path]:
    return [path for path in folder.rglob("*") if path.suffix != ".pyc" and path.is_file()]


def _version(path: Path) -> tuple[int, int, int]:
    """Return a file's inode, size and modification time [ns]; a change of the file changes at least one of them."""
    status = path.stat()
    return status.st_ino, status.st_size, status.st_mtime_ns
