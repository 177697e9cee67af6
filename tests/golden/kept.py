"""The recorded journals and homes, placed as `.lumen/` of a project to be read."""

import shutil
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

from tests.golden.adapters import KeptBundles
from tests.golden.golden import HERE

JOURNALS = HERE / "journals"
BUNDLES = JOURNALS / "bundles"
_FOLDER = TemporaryDirectory()


@cache
def bundles(robot: str) -> KeptBundles:
    """All recorded bundles, in the home of a project that has nothing else; each is loaded once."""
    root = Path(_FOLDER.name) / (robot or "one")
    shutil.copytree(BUNDLES, root / ".lumen" / "robots" / robot if robot else root / ".lumen")
    return KeptBundles(root, robot)


def journals() -> dict[str, list[Path]]:
    """Return the files of each recorded journal, in their order, by its name."""
    found: dict[str, list[Path]] = {}
    for file in sorted(JOURNALS.rglob("*.journal")):
        found.setdefault(str(file.parent.relative_to(JOURNALS)), []).append(file)
    return found
