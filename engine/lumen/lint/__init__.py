"""Lint: from a project's files to all findings in them."""

from collections.abc import Callable, Iterator, Mapping
from datetime import date
from itertools import chain
from pathlib import Path

from lumen.feature import Feature, distribution_of, resolve, rows
from lumen.language.diagnostics import Diagnostic, has_errors
from lumen.language.projects import Project
from lumen.lint.codes import codes
from lumen.lint.ignores import obey
from lumen.lint.several_robots import together
from lumen.project.assembly import assemble
from lumen.project.broken_features import broken, faults_reported, is_finding, shown
from lumen.project.building import draft
from lumen.project.chosen_robot import as_robot, chosen_robot
from lumen.project.draft import ProjectDraft
from lumen.project.files import read_files
from lumen.project.looks import Looks
from lumen.project.packaged import find_project
from lumen.project.sections import has_section


def check(path: str | Path | None = None) -> list[Diagnostic]:
    """Return all findings in a project, sorted by file and line; errors in its files are findings, not exceptions.

    `path` is the project's folder; None is the project around the working directory (`find_project`). Raises UsageError
    if there is no such folder.
    """
    root = find_project(path)
    return list(check_files(root, read_files(root))[1])


def check_files(
    root: Path,
    files: Mapping[str, bytes],
    between: Callable[[], None] = lambda: None,
    looks: Looks | None = None,
) -> tuple[Project | None, tuple[Diagnostic, ...]]:
    """Return the project that these files make, None if they have errors, and all findings in them.

    If the project has several robots, the files can choose one of them (`as_robot`); without a choice the findings are
    those of all robots, and the project is that of the first robot. `between` is called before each rule, so that a
    caller can stop the check by raising an exception. `looks` records which other paths on disk were examined.
    """
    looks = looks or Looks()
    found, diagnostics = _checked(root, files, between, looks)
    if found.settings and not chosen_robot(files):
        others = list(found.settings.robots)[1:]
        views = [_checked(root, as_robot(files, robot), between, looks)[1] for robot in others]
        diagnostics = together((diagnostics, *views))
    project = None if has_errors(diagnostics) else assemble(found, str(root.absolute()))
    return project, diagnostics


def _checked(
    root: Path, files: Mapping[str, bytes], between: Callable[[], None], looks: Looks
) -> tuple[ProjectDraft, tuple[Diagnostic, ...]]:
    """Return the draft that these files make for one robot, and all findings in them."""
    found = draft(files)
    found.root, found.today, found.looks = root, date.today(), looks
    for feature, rule in chain(rows("rules"), _section_rules(found), rows("last_rules")):
        between()
        _apply(feature, rule, found)
    documents = {file: report.document for file, report in found.reports.items()}
    return found, obey(found.diagnostics, documents, codes)


def _section_rules(found: ProjectDraft) -> Iterator[tuple[Feature, str]]:
    """Yield the rules of the sections and files that the project has."""
    data = found.main.document.data if found.main else None
    for feature, (name, rule) in rows("section_rules"):
        if name in found.reports or has_section(data, name):
            yield feature, rule


def _apply(feature: Feature, rule: str, found: ProjectDraft) -> None:
    """Run a rule; a fault of a rule that another installed package provides becomes a finding."""
    returned, distribution = None, distribution_of(feature)
    before = {name: _copy(value) for name, value in vars(found).items()} if distribution else {}
    reports = [(report, {**vars(report)}) for report in found.reports.values()] if distribution else []
    with faults_reported(feature, f"its rule `{rule}`", found.loose.append):
        returned = resolve(rule)(found)
    if distribution:
        changed = [name for name, value in before.items() if not _same(vars(found).get(name), value)]
        vars(found).update((name, before[name]) for name in changed)
        for report, parts in reports:
            changed += (f"reports.{name}" for name, part in parts.items() if vars(report).get(name) is not part)
            vars(report).update(parts)
        faults = [f"changed `{name}` of the draft: a rule reads the draft, and reports findings" for name in changed]
        faults += [f"reported {shown(each)}, which is no finding" for each in _remove_unsound(found)]
        if returned is not None:
            faults.append(f"returned {shown(returned)}: a rule reports its findings, and returns None")
        found.loose += (broken(distribution, f"its rule `{rule}` {fault}") for fault in faults[:1])


def _copy(part: object) -> object:
    """Return a copy of a part of a draft if it is a mapping or a set, else the part itself."""
    return part.copy() if isinstance(part, dict | set) else part


def _same(part: object, before: object) -> bool:
    """Return whether a part of a draft has the same content as before, as far as `_copy` copies it."""
    if isinstance(part, dict) and isinstance(before, dict):
        return part.keys() == before.keys() and all(part[name] is before[name] for name in before)
    return part == before if isinstance(before, set) else part is before


def _remove_unsound(found: ProjectDraft) -> Iterator[object]:
    """Remove values that are not valid findings from a draft, and yield them."""
    for findings in (found.loose, *(report.diagnostics for report in found.reports.values())):
        unsound = [each for each in findings if not is_finding(each)]
        findings[:] = (each for each in findings if each not in unsound)
        yield from unsound
