"""The files of tests that stand nearest to what has changed, the nearest first: what `make quick` runs, in that order.

    python scripts/nearest.py [FOLDER]

Changed is what differs from where this branch left `main` (`origin/main` where there is none), saved or committed. Near
is a test that was changed itself or has a changed file in its folder, then one that imports a changed module, then one
that imports an importer of it, and so on.
"""

import shutil
import subprocess
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path

import grimp

ROOT = Path(__file__).parents[1]
MOST = 200
"""How many files at most: more than are begun in `make quick`, whose workers read all of them before the first test."""
FAR = 1_000
"""The distance of what no change can be reached from."""


def main() -> None:
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "tests")
    sys.path.insert(0, str(ROOT))
    graph = grimp.build_graph("lumen", "tests", cache_dir=None)
    files = [file.relative_to(ROOT) for file in sorted((ROOT / folder).rglob("test_*.py"))] or [folder]
    print(*nearest(files, changed(), importers(graph))[:MOST], sep="\n")


def changed() -> list[Path]:
    """The files that differ from the common ancestor with `main`, those that git has never seen among them."""
    bases = [git("merge-base", "HEAD", base) for base in ("main", "origin/main")]
    base = next((base[0] for base in bases if base), "HEAD")
    return [Path(name) for name in git("diff", "--name-only", base) + git("ls-files", "--others", "--exclude-standard")]


def git(*words: str) -> list[str]:
    """Return the lines that git prints; none if there is no git, or no repository, as in an archive of the sources."""
    if not shutil.which("git"):
        return []
    done = subprocess.run(["git", *words], cwd=ROOT, capture_output=True, text=True, check=False)
    return done.stdout.splitlines()


def importers(graph: grimp.ImportGraph) -> Mapping[str, set[str]]:
    """Who imports a module."""
    return {module: graph.find_modules_that_directly_import(module) for module in graph.modules}


def nearest(files: list[Path], changes: Iterable[Path], importers: Mapping[str, set[str]]) -> list[Path]:
    """The files of tests by their distance from the changes; those as far as each other stay in their order."""
    folders = {change.parent for change in changes if change.suffix != ".py"}
    near = distances({module(change) for change in changes if change.suffix == ".py"}, importers)
    return sorted(files, key=lambda file: 0 if folders.intersection(file.parents) else near.get(module(file), FAR))


def module(file: Path) -> str:
    """The dotted name of a file of the engine or the tests."""
    name = ".".join(file.with_suffix("").parts).removeprefix("engine.")
    return name.removesuffix(".__init__")


def distances(changed: set[str], importers: Mapping[str, set[str]]) -> dict[str, int]:
    """How many imports lead from each module to a changed one."""
    found: dict[str, int] = {}
    edge, distance = changed, 0
    while edge:
        found |= dict.fromkeys(edge, distance)
        edge = {one for each in edge for one in importers.get(each, ())} - found.keys()
        distance += 1
    return found


if __name__ == "__main__":
    main()
