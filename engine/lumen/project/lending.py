"""Files that come with Lumen and that a project may use without a copy: robots' bodies, a hall, message schemas.

Only files that the project names are lent, and only if it has no file of that name: its own file has priority.
"""

import json
from collections.abc import Collection, Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Any

from lumen.language.projects import Project
from lumen.project.messages import SCHEMA_SUFFIX
from lumen.project.packaged import shipped_root
from lumen.project.project_folders import MESSAGES, MODELS, PASSAGES
from lumen.project.settings import Settings


def lend(files: Mapping[str, bytes], settings: Settings, models: Collection[str]) -> dict[str, bytes]:
    """Return the shipped files, by their path, that this project needs and does not have.

    `models` are the names of the bodies that are needed, and of the MJCF files of the project's own.
    """
    schemas = [f"{MESSAGES}/{route.schema}{SCHEMA_SUFFIX}" for route in settings.routes.values() if route.schema]
    wanted = [*schemas, *(f"{MODELS}/{name}" for name in (settings.hall, *models) if name)]
    if any(f"{MODELS}/{name}.yaml" not in files for name in models if f"{MODELS}/{name}.yaml" in shipped()):
        wanted += _bodies(files)
    return {file: shipped()[file].read_bytes() for file in wanted if file not in files and file in shipped()}


def _bodies(files: Mapping[str, bytes]) -> Iterator[str]:
    """Yield all shipped bodies with an MJCF, since one may be `like` another, and the passages between postures."""
    own = any(file.startswith(f"{PASSAGES}/") for file in files)
    for file, path in shipped().items():
        if file.startswith(f"{PASSAGES}/"):
            if not own:
                yield file
        elif file.startswith(f"{MODELS}/") and path.with_suffix(".yaml").exists():
            yield file


def model_files(project: Project) -> tuple[Path, str]:
    """Return the folder with the MJCF of the robot, and the path of the hall relative to it.

    Each file is the project's own if it exists, else the one that comes with Lumen. The path of the hall is absolute if
    the two are in different folders.
    """
    own = Path(project.root) / MODELS
    robot = own if (own / project.body.mjcf).exists() else shipped_root() / MODELS
    hall = own if (own / project.hall).exists() else shipped_root() / MODELS
    return robot, project.hall if hall == robot else str(hall.absolute() / project.hall)


@cache
def shipped_message(name: str) -> Any:
    """Return the schema of a message that comes with Lumen, shared by all callers; None if no schema has that name."""
    file = shipped().get(f"{MESSAGES}/{name}{SCHEMA_SUFFIX}")
    return json.loads(file.read_bytes()) if file else None


def shipped_models() -> tuple[str, ...]:
    """Return the names of the bodies that come with Lumen."""
    return tuple(
        Path(file).stem
        for file in shipped()
        if file.startswith(f"{MODELS}/") and file.endswith(".yaml") and not file.startswith(f"{PASSAGES}/")
    )


def shipped_names(folder: str) -> tuple[str, ...]:
    """Return the names that a project may use without a file of its own in that folder."""
    if folder == MESSAGES:
        files = (Path(file) for file in shipped())
        return tuple(file.name.removesuffix(SCHEMA_SUFFIX) for file in files if file.parent == Path(MESSAGES))
    return shipped_models() if folder == MODELS else ()


@cache
def shipped() -> Mapping[str, Path]:
    """Return all files that may be lent, by path. A project can't refer to any other file of Lumen."""
    endings = {MODELS: (".yaml", ".xml"), MESSAGES: (SCHEMA_SUFFIX,), PASSAGES: (".yaml",)}
    return {
        f"{folder}/{file.name}": file
        for folder, ends in endings.items()
        for file in sorted((shipped_root() / folder).iterdir())
        if file.name.endswith(ends)
    }
