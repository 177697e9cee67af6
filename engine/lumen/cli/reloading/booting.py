"""Which files a start begins with: those that are there, or the last good ones where those can't be."""

import sys
from collections.abc import Sequence
from pathlib import Path

from lumen.cli.reloading.bulletin import START, Bulletin
from lumen.cli.reloading.judging import Judged
from lumen.cli.reloading.premises import Premises
from lumen.cli.reloading.probation import PERIOD
from lumen.errors import ProjectError
from lumen.language.diagnostics import Diagnostic
from lumen.language.projects import Project
from lumen.loading.files import fingerprint, read_files
from lumen.rules import check_files
from lumen.runtime.crash_counter import DEATHS
from lumen.runtime.watcher import SavedFiles


def boot(root: Path, premises: Premises, *, last_good: bool) -> Project:
    """The project in that folder; the last good one where it has errors and that is wanted, or ends every start.

    Raises ProjectError where there is none to begin with.
    """
    files = read_files(root)
    project, diagnostics = check_files(root, files)
    if project is None:
        good = premises.last_good()
        if good and last_good:
            _say("THE FILES HAVE ERRORS", "")
            return _instead(premises, good, fingerprint(files), "", diagnostics)
        if good:
            print("`lumen run --last-good` starts with the last files that had no errors.", file=sys.stderr)
        raise ProjectError(diagnostics)
    if (died := premises.records.died(project.hash)) >= DEATHS:
        good = premises.last_good()
        if good and good.hash != project.hash:
            why = f"these files ended the exhibition {died} times within {PERIOD:.0f} s of their start"
            _say(why.upper(), "Save them again, or `lumen reload`, to have them tried again.\n")
            return _instead(premises, good, project.hash, why)
    premises.begin(project, files)
    return project


def _instead(premises: Premises, good: Project, hash: str, why: str, diagnostics: Sequence[Diagnostic] = ()) -> Project:
    """The last good project; that it is another is news."""
    judged = Judged(SavedFiles({}, (), 0.0, 0.0), hash, None, tuple(diagnostics))
    premises.news.append(Bulletin("refused", START, good.hash, hash, judged=judged, reason=why))
    return good


def _say(what: str, more: str) -> None:
    print(f"\n{what}: IT STARTS WITH THE LAST GOOD ONES, AND NOT WITH YOURS.\n{more}", file=sys.stderr)
