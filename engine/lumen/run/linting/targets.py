"""The projects and files that the command line names for lint, and the findings in them."""

import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

from lumen.errors import UsageError
from lumen.language.diagnostics import Diagnostic
from lumen.project.common_words import own_files
from lumen.project.files import MAX_FILE_BYTES, belongs, composed, read_files
from lumen.project.packaged import project_above
from lumen.project.project_folders import MAIN_FILE
from lumen.project.running_project import own_project
from lumen.run.linting.findings import Findings
from lumen.run.linting.kept_findings import known_or_checked

Wanted = Callable[[Diagnostic], bool]
"""A function that returns whether a finding is shown."""
STDIN = "-"


@dataclass(frozen=True)
class LintTarget:
    """A project to lint, or some of its files."""

    root: Path
    only: frozenset[str] = frozenset()
    """The files that were named; empty for the whole project."""
    typed: tuple[tuple[str, bytes], ...] = ()
    """Contents that replace those on the disk, with their paths."""

    def files(self) -> dict[str, bytes]:
        """Return the project's own files with their contents, sorted by path."""
        return dict(sorted({**own_files(read_files(self.root)), **dict(self.typed)}.items()))

    def shown(self, diagnostic: Diagnostic) -> bool:
        """Return whether a finding is in a file that was named, or no file was."""
        return not self.only or diagnostic.place.file in self.only


class FindingsOf(Protocol):
    """A function that lints a project; `files` are its contents if they were already read."""

    def __call__(self, what: LintTarget, files: Mapping[str, bytes] | None = None) -> Findings: ...


def lint_targets(paths: Sequence[str], stdin_name: str | None = None, *, whole: bool = False) -> list[LintTarget]:
    """Return the projects that these paths name or lie in; without paths, the project here or above.

    For a file, only findings in that file are shown; with `whole`, those of its whole project. `-` reads standard input
    as the file `stdin_name`. Raises UsageError for a path outside a project, and for a file that lint does not read.
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
    """Return the wanted findings of a project, and the number of those in files that were not named.

    `files` are its contents if they were already read. With `kept`, earlier findings may be reused.
    """
    files = what.files() if files is None else own_files(files)
    found = [d for d in checked(what.root, files, kept=kept) if wanted(d)]
    shown = [d for d in found if what.shown(d)]
    return Findings(shown, files, str(what.root), what.only, len(found) - len(shown))


def checked(root: Path, files: Mapping[str, bytes], *, kept: bool = False) -> tuple[Diagnostic, ...]:
    """Return all findings in these files; with `kept`, earlier ones of the same files may be reused."""
    if kept:
        return known_or_checked(root, files)
    from lumen.lint import check_files  # slow to import, and not needed if findings are kept

    return check_files(root, files)[1]


def _owner(path: str, whole: bool) -> tuple[Path, set[str]]:
    """Return the project of a folder or file, and the files in it that are meant; an empty set stands for all.

    Raises UsageError if the path can't be read, belongs to no project or has no file that lint reads.
    """
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
    """Return the nearest project above a file or folder, else None."""
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
