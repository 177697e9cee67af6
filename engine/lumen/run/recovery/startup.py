"""The files with which a run starts: the present ones, or the last good ones if those can't be used."""

from collections.abc import Callable, Sequence
from pathlib import Path

from lumen.errors import FatalFilesError, ProjectError
from lumen.language.diagnostics import Diagnostic, Place
from lumen.language.projects import Project
from lumen.project.broken_features import BROKEN_FEATURE
from lumen.project.crash_counter import MAX_CRASHES
from lumen.project.files import fingerprint, read_files
from lumen.project.project_folders import MAIN_FILE
from lumen.run.recovery.run_directory import RunDirectory
from lumen.run.reload.report import START, ReloadReport
from lumen.run.reload.rollback_guard import PERIOD
from lumen.run.reload.validation_worker import load_apart
from lumen.run.reload.validator import Validation
from lumen.run.watcher import SavedFiles


def startup_project(
    root: Path,
    run_directory: RunDirectory,
    *,
    last_good: bool,
    warn: Callable[[str], None] = lambda _: None,
    tell_fault: Callable[[str], None] = lambda _: None,
) -> Project:
    """Return the project in a folder, or the last good one.

    The last good one is used if the project has errors and `last_good` is set, or if it crashed at several starts.
    `warn` is called with lines for the operator, `tell_fault` with faults of packages that read parts of the files.
    Files are first read in another process, because they may crash it.
    Raises ProjectError or FatalFilesError if neither can be used.
    """
    files = read_files(root, run_directory.robot)
    try:
        project, diagnostics = load_apart(root, files)
        if project is None:
            raise ProjectError(diagnostics)
    except (ProjectError, FatalFilesError) as error:
        good = run_directory.last_good()
        if good and last_good:
            return _last_good(run_directory, good, fingerprint(files), error, warn)
        if good:
            warn("`lumen run --last-good` starts with the last files that had no errors.")
        raise
    if (died := run_directory.records.died(project.hash)) >= MAX_CRASHES:
        good = run_directory.last_good()
        if good and good.hash != project.hash:
            why = f"the exhibition ended {died} times within {PERIOD:.0f} s of its start with these files"
            warn(_instead_of_yours(why.upper(), "Save them again or run `lumen reload` to try them again.\n"))
            return _instead(run_directory, good, project.hash, why)
    for finding in diagnostics:
        if finding.code == BROKEN_FEATURE and finding.place != Place(MAIN_FILE):  # else the command has printed it
            tell_fault(str(finding))
    run_directory.begin(project, files)
    return project


def _last_good(
    run_directory: RunDirectory,
    good: Project,
    hash: str,
    error: ProjectError | FatalFilesError,
    warn: Callable[[str], None],
) -> Project:
    """Return the last good project in place of files that can't be used, and warn about that."""
    if isinstance(error, ProjectError):
        warn(_instead_of_yours("THE FILES HAVE ERRORS"))
        return _instead(run_directory, good, hash, "", error.diagnostics)
    warn(_instead_of_yours("THE FILES END THE PROCESS THAT READS THEM"))
    return _instead(run_directory, good, hash, str(error))


def _instead(
    run_directory: RunDirectory, good: Project, hash: str, why: str, diagnostics: Sequence[Diagnostic] = ()
) -> Project:
    """Return the last good project, and record the refusal of the present files."""
    validation = Validation(SavedFiles({}, (), 0.0, 0.0), hash, None, tuple(diagnostics))
    run_directory.news.append(ReloadReport("refused", START, good.hash, hash, validation=validation, reason=why))
    return good


def _instead_of_yours(what: str, more: str = "") -> str:
    return f"\n{what}: IT STARTS WITH THE LAST GOOD ONES, AND NOT WITH YOURS.\n{more}"
