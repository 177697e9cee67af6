"""Where the shipped exhibition and the engine's own schemas are, and which project is meant by a path or by none."""

from functools import cache
from pathlib import Path

from lumen.errors import UsageError

MAIN_FILE = "lumen.yaml"
_PACKAGE = Path(__file__).parents[1]


@cache
def shipped_root() -> Path:
    """The folder of the shipped exhibition: inside the wheel, else the repository's root."""
    inside = _PACKAGE / "exhibition"
    return inside if inside.is_dir() else _PACKAGE.parents[1]


def schema_folder() -> Path:
    """The folder of `KIND.schema.json`; always the engine's own, whatever a project holds."""
    return shipped_root() / "schemas"


def project_above(here: Path) -> Path | None:
    """This folder or its nearest parent with a lumen.yaml; None where there is none."""
    return next((folder for folder in (here, *here.parents) if (folder / MAIN_FILE).is_file()), None)


def find_project(path: str | Path | None = None) -> Path:
    """The folder of a project: `path`, else the working directory or the nearest parent with a lumen.yaml, else the
    shipped one. `path` may name the folder or its lumen.yaml. Raises UsageError where there is no such folder.
    """
    if path is None:
        return project_above(Path.cwd()) or shipped_root()
    folder = Path(path)
    try:
        if folder.name == MAIN_FILE and folder.is_file():
            folder = folder.parent
        if folder.is_dir():
            return folder
        reason = "is a file: name the folder that holds its lumen.yaml" if folder.exists() else "does not exist"
    except (OSError, ValueError) as error:
        reason = f"can't be read: {getattr(error, 'strerror', None) or error}"
    raise UsageError(f"{folder} {reason}")
