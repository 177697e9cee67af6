"""Which projects and files somebody asks lint about, and what it finds in them."""

import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from lumen.errors import UsageError
from lumen.language.diagnostics import Diagnostic
from lumen.project.common_words import own_files
from lumen.project.files import MAX_FILE_BYTES, belongs, composed, read_files
from lumen.project.own_project import own_project
from lumen.project.packaged import project_above
from lumen.project.project_folders import MAIN_FILE
from lumen.run.linting.findings import Findings
from lumen.run.linting.kept_findings import known_or_checked

Wanted = Callable[[Diagnostic], bool]
STDIN = "-"


@dataclass(frozen=True)
class LintTarget:
    """A project; `only` are the files of it that were named, none where it is meant as a whole.

    `typed` are contents that stand in place of those on the disk.
    """

    root: Path
    only: frozenset[str] = frozenset()
    typed: tuple[tuple[str, bytes], ...] = ()

    def files(self) -> dict[str, bytes]:
        return dict(sorted({**own_files(read_files(self.root)), **dict(self.typed)}.items()))

    def shown(self, diagnostic: Diagnostic) -> bool:
        return not self.only or diagnostic.place.file in self.only


class FindingsOf(Protocol):
    """What finds what is wrong in a project; `files` are what it holds, where somebody has read them already."""

    def __call__(self, what: LintTarget, files: Mapping[str, bytes] | None = None) -> Findings: ...


def lint_targets(paths: Sequence[str], stdin_name: str | None = None, *, whole: bool = False) -> list[LintTarget]:
    """The projects that these folders and files are or belong to; without any, the one here or above.

    Of a file its project is meant with nothing shown but what is in that file; with `whole` all of the project.
    Raises UsageError for what is neither, and for a file that lint does not read.
    """
    if STDIN in paths:
        return [_typed(paths, stdin_name)]
    if stdin_name:
        raise UsageError("--stdin-filename needs `-`: write `lumen lint - --stdin-filename FILE`")
    if not paths:
        return [LintTarget(own_project())]
    projects: dict[Path, set[str] | None] = {}
    for path in paths:
        root, files = _owner(path, whole)
        known = projects.setdefault(root.resolve(), set())
        projects[root.resolve()] = known | files if files and known is not None else None
    return [LintTarget(root, frozenset(only or ())) for root, only in projects.items()]


def lint(what: LintTarget, wanted: Wanted, files: Mapping[str, bytes] | None = None, *, kept: bool = False) -> Findings:
    """The findings of a project that are wanted, those in files that nobody asked about counted.

    `files` are what it holds, where somebody has read them already. With `kept` also from what was found before.
    """
    files = what.files() if files is None else own_files(files)
    found = [d for d in checked(what.root, files, kept=kept) if wanted(d)]
    shown = [d for d in found if what.shown(d)]
    return Findings(shown, files, str(what.root), what.only, len(found) - len(shown))


def checked(root: Path, files: Mapping[str, bytes], *, kept: bool = False) -> tuple[Diagnostic, ...]:
    """Everything wrong with these files; with `kept` also from what was found in the very same ones before."""
    if kept:
        return known_or_checked(root, files)
    from lumen.lint import check_files  # not where everything is known

    return check_files(root, files)[1]


def _owner(path: str, whole: bool) -> tuple[Path, set[str]]:
    """The project of a folder or file, and which of its files are meant; empty for the whole."""
    here = Path(path)
    try:
        alone = here.is_file() and here.name != MAIN_FILE
        inside = here.is_dir() and not (here / MAIN_FILE).exists() and _root(here) is not None
    except (OSError, ValueError) as error:
        raise UsageError(f"{path} can't be read: {getattr(error, 'strerror', None) or error}") from None
    if not (alone or inside):
        return own_project(here), set()
    root = _root(here)
    if root is None:
        raise UsageError(f"{path} belongs to no project: there is no {MAIN_FILE} in its folder or above")
    if whole:
        return root, set()
    name = composed(here.absolute().relative_to(root).as_posix())
    files = {file for file in own_files(read_files(root)) if file == name or file.startswith(f"{name}/")}
    if not files:
        raise UsageError(f"{path} has no file that lint reads: docs/yaml.md lists the files of a project")
    return root, files


def _root(path: Path) -> Path | None:
    """The nearest project around a file or folder."""
    return project_above(path.absolute().parent)


def _typed(paths: Sequence[str], name: str | None) -> LintTarget:
    if len(paths) > 1 or not name:
        raise UsageError("`-` reads one file: write `lumen lint - --stdin-filename behaviors/NAME.yaml`")
    root = _root(Path(name))
    if root is None:
        raise UsageError(f"{name} belongs to no project: there is no {MAIN_FILE} in its folder or above")
    file = composed(Path(name).absolute().relative_to(root).as_posix())
    if not belongs(file):
        raise UsageError(f"{name} is not a file that lint reads: docs/yaml.md lists the files of a project")
    content = sys.stdin.buffer.read(MAX_FILE_BYTES + 1)
    if len(content) > MAX_FILE_BYTES:
        raise UsageError(
            f"standard input is larger than {MAX_FILE_BYTES // 1_000_000} MB, the limit for a file of a project"
        )
    return LintTarget(root, frozenset((file,)), ((file, content),))
