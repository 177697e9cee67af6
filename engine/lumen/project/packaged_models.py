"""Robots' models that a Python package carries: `mjcf: PACKAGE:PATH`, as `dm_control:suite/humanoid.xml`."""

from importlib.util import find_spec
from pathlib import Path


def in_package(mjcf: str) -> bool:
    """Whether a body's `mjcf` names a file of a package rather than one beside it."""
    return ":" in mjcf


def package_file(mjcf: str) -> Path | None:
    """The file of an installed package that `mjcf` names; None where there is no such package, or no such file in it.

    The package is not imported, and a path that leads out of it leads nowhere.
    """
    package, _, inner = mjcf.partition(":")
    try:
        spec = find_spec(package) if package.isidentifier() else None
        for folder in (spec and spec.submodule_search_locations) or ():
            path = (Path(folder) / inner).resolve()
            if path.is_relative_to(Path(folder).resolve()) and path.is_file():
                return path
    except (OSError, ValueError):  # a name with a NUL, or one that is in sys.modules without a spec
        return None
    return None


def mjcf_path(mjcf: str, models: Path) -> Path:
    """Where a body's model is: in its package, else in `models`, whether it is there or not."""
    return (package_file(mjcf) if in_package(mjcf) else None) or models / mjcf
