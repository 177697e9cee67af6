"""Repairs of a project that need no decision: a pure function from files to files."""

import re
from collections import Counter
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import NamedTuple

from lumen.errors import LumenError
from lumen.language.diagnostics import Diagnostic, Severity, has_errors
from lumen.lint.codes import codes
from lumen.lint.fixes import Edit, Fix, edited, usable_fixes
from lumen.project.yaml_errors import TAB, YAML_SYNTAX
from lumen.project.yaml_nodes import DUPLICATE_KEY

ProjectFiles = Mapping[str, bytes]
FileLinter = Callable[[ProjectFiles], Sequence[Diagnostic]]

_HIDING = frozenset((TAB, YAML_SYNTAX, DUPLICATE_KEY))
"""Faults that hide the rest of a file; their repair can reveal more findings."""

MAX_REPAIR_ROUNDS = 100
"""The maximum number of rounds, because a repair can reveal further findings.

Of several findings with one cause only the first is reported.
"""


class Repair(NamedTuple):
    """A finding, and the fix that removed it."""

    diagnostic: Diagnostic
    fix: Fix


def repaired(
    files: ProjectFiles,
    check: FileLinter,
    wanted: Callable[[Diagnostic], bool],
    failed: Callable[[LumenError], object] = lambda error: None,
) -> tuple[ProjectFiles, list[Repair]]:
    """Return the files with every fix of a wanted finding that improves them, and the repairs that were made.

    An improvement removes the finding and adds no other. All fixes are tried together; if that fails, each half of
    them is tried separately, and so on. `failed` is called with each fault of a repair that an installed package
    provides, perhaps several times; the other repairs are made.
    """
    found, done = check(files), list[Repair]()
    for _ in range(MAX_REPAIR_ROUNDS):
        before = len(done)
        steps = _steps([(d, usable_fixes(d, files, failed)) for d in found if wanted(d)])
        while steps:
            step = [r for r in steps.pop() if r.diagnostic in found]  # else it was repaired or has moved
            after = applied(files, step)
            then = check(after) if step else found
            if step and _better(found, then, step):
                files, found = after, then
                done += step
            elif len(step) > 1:
                steps += [step[len(step) // 2 :], step[: len(step) // 2]]
        if len(done) == before:
            break
    return files, done


def _steps(proposals: Sequence[tuple[Diagnostic, list[Fix]]]) -> list[list[Repair]]:
    """Return the repairs to try, the last first.

    They are the likeliest fix of every finding together, then each of the other fixes alone.
    """
    others = [[Repair(d, fix)] for d, proposed in proposals for fix in proposed[1:]]
    return [*reversed(others), [Repair(d, proposed[0]) for d, proposed in proposals if proposed]]


def applied(files: ProjectFiles, repairs: Iterable[Repair]) -> dict[str, bytes]:
    """Return the files with the edits of these repairs."""
    edits: dict[str, list[Edit]] = {}
    for repair in repairs:
        for edit in repair.fix.edits:
            edits.setdefault(edit.place.file, []).append(edit)
    return {**files, **{file: edited(files[file], those) for file, those in edits.items()}}


def _better(before: Sequence[Diagnostic], after: Sequence[Diagnostic], step: Sequence[Repair]) -> bool:
    """Return whether the findings of `step` are gone, and no new finding appeared, except formerly hidden ones."""
    then, now = Counter(map(_what, before)), Counter(map(_what, after))
    if any(now[_what(r.diagnostic)] >= then[_what(r.diagnostic)] for r in step):
        return False
    return all(_hidden(code, file, before, step) for file, code, _ in now - then)


def _hidden(code: str, file: str, before: Sequence[Diagnostic], step: Sequence[Repair]) -> bool:
    """Return whether a new finding may have existed before, hidden by a fault that the step repaired.

    Warnings such as those about unused parts appear only without errors. A repaired word may reveal errors in its file,
    and a repaired syntax error may reveal errors anywhere; but a new fault of syntax or shape was not hidden.
    """
    if code in codes() and codes()[code].severity is not Severity.ERROR:
        return has_errors(before)
    near = any(file == r.diagnostic.place.file or r.diagnostic.code in _HIDING for r in step)
    return near and codes()[code].family not in ("text", "shape")


def _what(diagnostic: Diagnostic) -> tuple[str, str, str]:
    """Return the file, code and message of a finding, without its place and numbers, which an edit can change."""
    return diagnostic.place.file, diagnostic.code, re.sub(r"\d+", "0", diagnostic.message)
