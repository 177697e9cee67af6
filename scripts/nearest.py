"""List the files of tests nearest to the changes, nearest first: `make quick` runs them in that order.

    python scripts/nearest.py [FOLDER]

Changes are all differences from the point at which this branch left `main` (`origin/main` without it), committed or
not. A test is near if it was changed itself or has a changed file in its folder; then come tests that import a changed
module, then those that import one of its importers, and so on.
"""

import shutil
import subprocess
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path

import grimp

ROOT = Path(__file__).parents[1]
MOST = 200
"""The number of files, at most: more than `make quick` can run; its workers read all of them before the first test."""
FAR = 1_000
"""The distance of a file from which no change can be reached."""


def main() -> None:
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "tests")
    sys.path.insert(0, str(ROOT))
    graph = grimp.build_graph("lumen", "tests", cache_dir=None)
    files = [file.relative_to(ROOT) for file in sorted((ROOT / folder).rglob("test_*.py"))] or [folder]
    print(*nearest(files, changed(), importers(graph))[:MOST], sep="\n")


def changed() -> list[Path]:
    """Return the files that differ from the common ancestor with `main`, including untracked files."""
    bases = [git("merge-base", "HEAD", base) for base in ("main", "origin/main")]
    base = next((base[0] for base in bases if base), "HEAD")
    return [Path(name) for name in git("diff", "--name-only", base) + git("ls-files", "--others", "--exclude-standard")]


def git(*words: str) -> list[str]:
    """Return the lines that git prints; none without git or a repository, as in an archive of the sources."""
    if not shutil.which("git"):
        return []
    done = subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True, check=False)
    return done.stdout.splitlines()


def importers(graph: grimp.ImportGraph) -> Mapping[str, set[str]]:
    """Return the direct importers of each module."""
    return {module: graph.find_modules_that_directly_import(module) for module in graph.modules}


def nearest(files: list[Path], changes: Iterable[Path], importers: Mapping[str, set[str]]) -> list[Path]:
    """Return the files of tests by their distance from the changes; equally distant ones keep their order."""
    folders = {change.parent for change in changes if change.suffix != ".py"}
    near = distances({module(change) for change in changes if change.suffix == ".py"}, importers)
    return sorted(files, key=lambda file: 0 if folders.intersection(file.parents) else near.get(module(file), FAR))


def module(file: Path) -> str:
    """Return the dotted name of a file of the engine or the tests."""
    name = ".".join(file.with_suffix("").parts).removeprefix("engine.")
    return name.removesuffix(".__init__")


def distances(changed: set[str], importers: Mapping[str, set[str]]) -> dict[str, int]:
    """Return the number of imports on the shortest way from each module to a changed one."""
    found: dict[str, int] = {}
    edge, distance = changed, 0
    while edge:
        found |= dict.fromkeys(edge, distance)
        edge = {one for each in edge for one in importers.get(each, ())} - found.keys()
        distance += 1
    return found


if __name__ == "__main__":
    main()
