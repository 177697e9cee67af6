"""Move the files of the engine to where `scripts/moves.toml` says, and rewrite whatever names them.

    python scripts/moves.py                     # the stages, and how many files of each are still to move
    python scripts/moves.py --check STAGE …     # what a stage would do
    python scripts/moves.py STAGE …             # do it; a stage that is done can be repeated, as after a merge

Imports are rewritten by syntax tree. A name that only looks like a moved module or path is rewritten in the files that
`texts` lists but `leave` does not, and printed if neither lists the file: a person decides.

The tool commits nothing. `git commit --all` makes one commit of moves and references. To git a file that mostly has
imports is then a new one; the tool prints such files. If `git log --follow` must reach their history, commit what is
staged first, the moves alone; that commit can't be imported.
"""

import argparse
import ast
import shutil
import subprocess
import sys
import tomllib
from collections import Counter
from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from fnmatch import fnmatchcase
from pathlib import Path, PurePosixPath
from typing import Any, Self

from references import PACKAGE, Edit, Moved, code_edits, module_of, page_edits, rewritten, spelled_edits

ROOT = Path(__file__).parents[1]
GOES = "-"
"""The target of a file that is deleted when nothing else is left in its folder."""
PYTHON = (".py", ".pyi")


@dataclass(frozen=True, slots=True)
class Plan:
    """The rows of moves.toml. A path ends in `/` if it is a folder; the row with the longest matching path applies."""

    stages: Mapping[str, Mapping[str, str]]
    stays: Sequence[str]
    packages: Mapping[str, str]
    """The docstrings of new packages."""
    texts: Sequence[str]
    """Files in which names are rewritten in strings, comments and prose."""
    leave: Sequence[str]
    """Files that keep the names of old modules in strings and prose."""

    @classmethod
    def of(cls, data: Mapping[str, Any]) -> Self:
        """Return the plan in the data of a moves.toml."""
        return cls(data["stages"], data["stays"], data.get("packages", {}), data["texts"], data["leave"])

    def rows(self) -> dict[str, str]:
        """Return all rows: the sources and their targets."""
        return {source: target for rows in self.stages.values() for source, target in rows.items()}

    def row(self, path: str) -> str | None:
        """Return the source of the row that moves a file; None if the file stays."""
        found = max((row for row in (*self.rows(), *self.stays) if _covers(row, path)), key=len, default=None)
        return None if found in self.stays else found


def _covers(row: str, path: str) -> bool:
    return path.startswith(row) if row.endswith("/") else path == row


def _below(row: str, target: str, path: str) -> str:
    """Return the new path of a file by its row."""
    return target + path.removeprefix(row) if row.endswith("/") else target


def problems(plan: Plan, files: Sequence[str], exports: Mapping[str, Sequence[str]]) -> list[str]:
    """Return the problems of a plan for these files; `exports` are the public names by packages' new folders."""
    rows = plan.rows()
    homes = {*plan.stays, *rows.values(), *(f"{package}/__init__.py" for package in plan.packages)}
    found = {path: plan.row(path) for path in files}
    used = {row for row in found.values() if row}
    waiting = {*waits(plan, files)}
    goals = Counter(_below(row, rows[row], path) if row else path for path, row in found.items() if path not in waiting)
    lost = [path for path, row in found.items() if row is None and not any(_covers(home, path) for home in homes)]
    done = {row for row, target in rows.items() if target == GOES or any(_covers(target, path) for path in files)}
    folders = {folder for goal in goals if goal.endswith(PYTHON) for folder in PurePosixPath(goal).parents[:-1]}
    bare = [folder for folder in map(str, folders) if f"{folder}/__init__.py" not in goals]
    return [
        *(f"no row for {path}" for path in lost),
        *(f"no file for the row {row}" for row in rows if row not in used and row not in done),
        *(f"{number} files become {goal}" for goal, number in goals.items() if number > 1),
        *(f"no docstring for the new package {folder}" for folder in sorted(bare) if folder not in plan.packages),
        *(
            f"{goal} hides the name `{PurePosixPath(goal).stem}` of its package"
            for goal in sorted(goals)
            if PurePosixPath(goal).stem in exports.get(PurePosixPath(goal).parent.as_posix(), ())
        ),
    ]


def exports(plan: Plan, package: Path, files: Iterable[str]) -> dict[str, list[str]]:
    """Return the names in `__all__` of each package, by the new folder."""
    rows, found = plan.rows(), {}
    for path in files:
        row = plan.row(path)
        goal = PurePosixPath(_below(row, rows[row], path) if row else path)
        if goal.name == "__init__.py":
            found[goal.parent.as_posix()] = _listed_names(ast.parse((package / path).read_text("utf-8")))
    return found


def waits(plan: Plan, files: Collection[str]) -> list[str]:
    """Return the files that stay until their folder is empty: those to delete, and those that keep the rest a package.

    A stage that moves the `__init__.py` of a folder whose other files move later leaves an empty one.
    """
    rows, found = plan.rows(), []
    for path in files:
        if row := plan.row(path):
            goal = _below(row, rows[row], path)
            if goal == GOES or (goal in files and PurePosixPath(path).name == "__init__.py"):
                found.append(path)
    return found


def moves(plan: Plan, stage: str, files: Collection[str]) -> dict[str, str]:
    """Return the old and new paths of the files of a stage that have not moved yet."""
    rows, waiting = plan.stages[stage], {*waits(plan, files)}
    found = {path: row for path in files if (row := plan.row(path)) and row in rows and path not in waiting}
    return {path: _below(row, rows[row], path) for path, row in found.items()}


def history(plan: Plan, stage: str, files: Iterable[str]) -> dict[str, str]:
    """Return the old and new paths of the files that a stage has moved already."""
    targets = {target: row for row, target in plan.stages[stage].items() if target != GOES}
    found = {}
    for path in files:
        target = max((target for target in targets if _covers(target, path)), key=len, default=None)
        if target is not None:
            row = targets[target]
            found[row + path.removeprefix(target) if target.endswith("/") else row] = path
    return found


class Mover:
    """Carries out stages in a checkout."""

    def __init__(self, root: Path, plan: Plan, *, check: bool = False) -> None:
        self.root, self.plan, self.check = root, plan, check
        self.undecided: list[str] = []
        self._origins: dict[str, str] = {}
        """The paths of moved files before they moved."""

    def tracked(self, folder: str = ".") -> list[str]:
        """Return the files of git below a folder that exist, by their paths from the folder."""
        listed = self._git("ls-files", "-z", "--", folder).split("\0")
        return [name.removeprefix(f"{folder}/") for name in listed if name and (self.root / name).is_file()]

    def problems(self) -> list[str]:
        """Return the problems of the plan in this checkout."""
        files = self.tracked(PACKAGE)
        return problems(self.plan, files, exports(self.plan, self.root / PACKAGE, files))

    def earlier(self, stage: str) -> str | None:
        """Return the first earlier stage with files to move, if any."""
        files, names = self.tracked(PACKAGE), list(self.plan.stages)
        return next((name for name in names[: names.index(stage)] if moves(self.plan, name, files)), None)

    def carry_out(self, stage: str) -> None:
        """Move the files of a stage, and rewrite the references to them."""
        before = self.tracked(PACKAGE)
        self._origins = {
            f"{PACKAGE}/{now}": f"{PACKAGE}/{then}"
            for one in self.plan.stages
            for then, now in history(self.plan, one, before).items()
        }
        new = moves(self.plan, stage, before)
        old = history(self.plan, stage, before)
        folders = {
            row.removesuffix("/"): target.removesuffix("/")
            for row, target in self.plan.stages[stage].items()
            if row.endswith("/")
        }
        moved = Moved({**old, **new}, folders, before, self._offered(before))
        goals = {f"{PACKAGE}/{path}": target for path, target in new.items()}
        origins = {target: path for path, target in new.items()}
        changed = [name for name in self.tracked() if self._rewrite(name, goals.get(name), moved)]
        for path, target in new.items():
            print(f"{path} -> {target}")
            if not self.check:
                self._move(f"{PACKAGE}/{path}", f"{PACKAGE}/{target}")
        print(f"{stage}: {len(new)} files moved, {len(changed)} files name them")
        if not self.check:
            self._new_packages(new.values())
            self._keep_packages(new)
            gone = self._remove()
            self._tidy({PurePosixPath(path).parent for path in (*new, *gone)})
            self._format([f"{PACKAGE}/{goals[name]}" if name in goals else name for name in changed])
            added = self._git("diff", "HEAD", "-M", "--diff-filter=A", "--name-only", "--", PACKAGE).splitlines()
            for target in sorted(set(new.values()) & {name.removeprefix(f"{PACKAGE}/") for name in added}):
                print(f"{target} differs so much that git does not follow it to {origins[target]}")

    def _offered(self, files: Iterable[str]) -> Iterator[str]:
        """Return the names in `__all__` of each package, with the package's name before a stage."""
        for path in files:
            if PurePosixPath(path).name == "__init__.py":
                origin = self._origins.get(f"{PACKAGE}/{path}", f"{PACKAGE}/{path}").removeprefix(f"{PACKAGE}/")
                for name in _listed_names(ast.parse((self.root / PACKAGE / path).read_text("utf-8"))):
                    yield from (f"{module_of(each)}.{name}" for each in (path, origin))

    def _rewrite(self, name: str, goal: str | None, moved: Moved) -> bool:
        """Rewrite the references in a file; `goal` is the new path of one that moves. Return True if there were any."""
        file = self.root / name
        try:
            text = file.read_text("utf-8")
        except UnicodeDecodeError:
            return False
        seen = moved.for_file(goal) if goal else moved
        edits = self._edits(name, text, seen)
        spelled = [] if self._is_listed(name, self.plan.leave) else spelled_edits(text, seen, edits)
        if self._is_listed(name, self.plan.texts):
            edits += spelled
        else:
            lines = sorted({text.count("\n", 0, edit.start) for edit in spelled})
            self.undecided += [f"{name}:{line + 1}: {text.splitlines()[line].strip()[:110]}" for line in lines]
        if edits and self.check:
            print(f"{name}: {len(edits)} references")
        elif edits:
            file.write_text(rewritten(text, edits), "utf-8", newline="")
        return bool(edits)

    def _edits(self, name: str, text: str, moved: Moved) -> list[Edit]:
        if name.endswith(PYTHON):
            try:
                return code_edits(text, moved)
            except SyntaxError:  # a file that a test of faults needs
                return []
            except ValueError as error:
                raise SystemExit(f"{name}: {error}") from None
        is_page = name.endswith(".md") and not self._is_listed(name, self.plan.leave)
        return page_edits(text, moved) if is_page else []

    def _is_listed(self, name: str, patterns: Sequence[str]) -> bool:
        """Return whether a pattern matches a file, by its path now or by the one before it moved."""
        return any(fnmatchcase(path, pattern) for path in (name, self._origins.get(name, name)) for pattern in patterns)

    def _move(self, source: str, target: str) -> None:
        (self.root / target).parent.mkdir(parents=True, exist_ok=True)
        self._git("mv", "--", source, target)

    def _new_packages(self, targets: Iterable[str]) -> None:
        """Write the `__init__.py` of each new package, unless a file becomes it."""
        python = {folder for target in targets if target.endswith(PYTHON) for folder in PurePosixPath(target).parents}
        data = {
            folder
            for target in targets
            for folder in PurePosixPath(target).parents
            if str(folder) in self.plan.packages
        }
        for folder in sorted(python | data):
            file = self.root / PACKAGE / folder / "__init__.py"
            if not file.exists():
                file.write_text(f'"""{self.plan.packages[folder.as_posix()]}"""\n', "utf-8")
                self._git("add", "--", str(file))

    def _keep_packages(self, moved: Iterable[str]) -> None:
        """Leave an empty `__init__.py` in a folder that keeps other files of Python."""
        left = self.tracked(PACKAGE)
        for path in moved:
            folder = PurePosixPath(path).parent
            if PurePosixPath(path).name == "__init__.py" and any(
                name.startswith(f"{folder}/") and name.endswith(PYTHON) for name in left
            ):
                (self.root / PACKAGE / path).touch()
                self._git("add", "--", f"{PACKAGE}/{path}")

    def _remove(self) -> list[str]:
        """Delete the waiting files that are alone in their folder now; return their paths."""
        left = self.tracked(PACKAGE)
        folders = [PurePosixPath(path).parent for path in left]
        folders += [folder for each in folders for folder in each.parents]
        gone = [path for path in waits(self.plan, left) if folders.count(PurePosixPath(path).parent) == 1]
        for path in gone:
            self._git("rm", "-q", "--force", "--", f"{PACKAGE}/{path}")
        return gone

    def _tidy(self, folders: Iterable[PurePosixPath]) -> None:
        """Delete folders that contain only compiled Python, because an import would treat them as packages."""
        for folder in sorted(folders, key=lambda folder: -len(folder.parts)):
            place = self.root / PACKAGE / folder
            if place.is_dir() and not [file for file in place.rglob("*") if file.is_file() and file.suffix != ".pyc"]:
                shutil.rmtree(place)

    def _format(self, names: Iterable[str]) -> None:
        """Sort the imports of changed files, and format them."""
        python = [name for name in names if name.endswith(PYTHON)]
        for command in (("check", "-q", "--fix", "--select", "I"), ("format", "-q")):
            if python:
                subprocess.run([sys.executable, "-m", "ruff", *command, "--", *python], cwd=self.root, check=True)

    def _git(self, *words: str) -> str:
        return subprocess.run(["git", *words], cwd=self.root, capture_output=True, text=True, check=True).stdout


def _listed_names(tree: ast.Module) -> list[str]:
    """Return the names in the `__all__` of a module."""
    for node in tree.body:
        match node:
            case ast.Assign(targets=[ast.Name(id="__all__")], value=ast.List() | ast.Tuple() as value):
                return [str(ast.literal_eval(each)) for each in value.elts]
    return []


def main(arguments: Sequence[str] | None = None) -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("stage", nargs="*", help="the stages to carry out, in this order")
    parser.add_argument("--check", action="store_true", help="only print what would happen")
    parser.add_argument("--root", type=Path, default=ROOT, help="the checkout (default: this one)")
    given = parser.parse_args(arguments)
    plan = Plan.of(tomllib.loads((given.root / "scripts/moves.toml").read_text("utf-8")))
    mover = Mover(given.root, plan, check=given.check)
    if wrong := mover.problems():
        raise SystemExit("\n".join(["the rows of scripts/moves.toml do not fit the files:", *wrong]))
    if unknown := [stage for stage in given.stage if stage not in plan.stages]:
        raise SystemExit(f"no stage {unknown[0]}: choose from {', '.join(plan.stages)}")
    for stage in given.stage:
        if not given.check and (earlier := mover.earlier(stage)):
            raise SystemExit(f"{stage}: carry out {earlier} before it")
        mover.carry_out(stage)
    if not given.stage:
        files = mover.tracked(PACKAGE)
        print(*(f"{stage:<16}{len(moves(plan, stage, files)):>5} files to move" for stage in plan.stages), sep="\n")
    if mover.undecided:
        raise SystemExit("\n".join(["add these files to `texts` or `leave` in scripts/moves.toml:", *mover.undecided]))


if __name__ == "__main__":
    main()
