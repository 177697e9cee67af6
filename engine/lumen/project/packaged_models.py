"""Robot models in a Python package: `mjcf: PACKAGE:PATH`, such as `dm_control:suite/humanoid.xml`."""

from importlib.util import find_spec
from pathlib import Path


def in_package(mjcf: str) -> bool:
    """Return True if a body's `mjcf` names a file of a package instead of one in its own folder."""
    return ":" in mjcf


def package_file(mjcf: str) -> Path | None:
    """Return the file of an installed package that `mjcf` names; None if there is no such package or file.

    The package is not imported. A path that leads out of the package counts as absent.
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
    """Return the path of a body's model: in its package, else in `models`, even if it does not exist there."""
    return (package_file(mjcf) if in_package(mjcf) else None) or models / mjcf
