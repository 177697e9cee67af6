"""`lumen lint --physics`: every motion played by the simulated robot, and by others that differ a little."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from math import inf
from pathlib import Path

from lumen.app.lint.findings import Findings
from lumen.app.lint.outcome_cache import OutcomeCache
from lumen.errors import UsageError
from lumen.language.diagnostics import Diagnostic
from lumen.language.imperfections import Imperfections
from lumen.language.projects import Project
from lumen.loading.lending import model_files
from lumen.rules import check_files
from lumen.rules.physics import Case, CaseResult, Outcome, SubjectFactory, attempt
from lumen.rules.physics.cases import cases
from lumen.rules.physics.verdict import findings

ROBOTS = 20
"""How many robots beside the one of the model play each motion, where nobody says."""

ProgressHook = Callable[[int, int, str], None]
"""Told how many performances are done, of how many, and of what is played now."""


def played(
    found: Findings,
    wanted: Callable[[Diagnostic], bool],
    robots: int,
    tell: ProgressHook = lambda *_: None,
    *,
    keep: bool = True,
    imperfections: Imperfections | None = None,
) -> tuple[Findings, list[CaseResult]]:
    """The findings of a project with those of its motions in simulation, where it has no errors; and what was played.

    `imperfections` are other than the project's. Only motions in files that somebody asked about are played, and with
    `keep` only where they were not before. Raises MissingExtraError where there is no simulation.
    """
    root = Path(found.root)
    project = check_files(root, found.files)[0]
    if project is None:
        return found, []
    project = replace(project, imperfections=imperfections or project.imperfections)
    make = _maker(project)
    chosen = [case for case in cases(project) if not found.asked or case.file in found.asked]
    memory = OutcomeCache(project, found.files) if keep else None
    rehearsals = play_cases(chosen, make, robots, memory, tell)
    more = [d for r in rehearsals for d in findings(r, project.documents[r.case.file], project.body) if wanted(d)]
    everything = sorted([*found.diagnostics, *dict.fromkeys(more)], key=lambda d: (d.place.file, d.place.line))
    return replace(found, diagnostics=everything), rehearsals


def play_cases(
    chosen: Sequence[Case], make: SubjectFactory, robots: int, memory: OutcomeCache | None, tell: ProgressHook
) -> list[CaseResult]:
    """What comes of each case with the robot of the model and `robots` others; what is remembered is not played."""
    done, whole, rehearsals = 0, len(chosen) * (robots + 1), []
    for case in chosen:
        outcomes = memory.recall(case) if memory else {}
        for number in range(robots + 1):
            tell(done, whole, case.motion.name)
            done += 1
            if number not in outcomes:
                outcomes[number] = _attempt(case, make, number)
                if memory:
                    memory.keep(case, outcomes)
        rehearsals.append(CaseResult(case, [outcomes[number] for number in range(robots + 1)]))
    return rehearsals


def summary(rehearsals: Sequence[CaseResult]) -> str:
    """A line for each case: how many came to its end, and how far the torso leaned."""
    lines = []
    for rehearsal in rehearsals:
        case, tried = rehearsal.case, rehearsal.tried
        well = sum(map(rehearsal.succeeded, tried))
        name = case.motion.name if case.passage else f"{case.motion.name} {case.way}"
        leaned = "" if case.passage else f", leaned {max((o.tilt for o in tried), default=0.0):.1f} deg at most"
        slid = max((m[1] for o in tried for m in o.slid.values()), default=0.0)
        slides = "" if case.passage or case.living else f", feet slid {1000 * slid:.0f} mm"
        lines.append(f"{name:<28} {well} of {len(tried)} robots{leaned}{slides}")
    return "\n".join(lines)


def number_of_robots(text: str) -> int:
    """What --robots says; raises UsageError for what is no such number."""
    number = int(text) if text.isdecimal() and text.isascii() and len(text) < 10 else inf
    if number > 1000:
        raise UsageError(f"--robots is a number from 0 to 1000, not `{text[:40]}`")
    return int(number)


def _attempt(case: Case, make: SubjectFactory, number: int) -> Outcome:
    robot = make(number)
    try:
        return attempt(case, robot)
    finally:
        robot.close()


def _maker(project: Project) -> SubjectFactory:
    from lumen.robots.simulation.subject import subject

    models, hall = model_files(project)
    return lambda number: subject(project.body, models, hall, number, project.imperfections)
