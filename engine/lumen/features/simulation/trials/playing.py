"""`lumen lint --physics`: play every motion on the simulated robot and on slightly different variants."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import closing
from dataclasses import replace
from math import inf
from pathlib import Path

from lumen.errors import UsageError
from lumen.extras import demand
from lumen.features.simulation.settings import Imperfections
from lumen.features.simulation.trials.cases import cases
from lumen.features.simulation.trials.outcome_cache import OutcomeCache
from lumen.features.simulation.trials.trial import CaseResult, Outcome, attempt
from lumen.features.simulation.trials.verdict import findings
from lumen.language.diagnostics import Diagnostic
from lumen.language.projects import Project
from lumen.lint import check_files
from lumen.project.lending import model_files
from lumen.run.linting.findings import Findings
from lumen.run.workers.tasks import UnpackedKit, WorkKit, models_in
from lumen.run.workers.workers import Workers

ROBOTS = 20
"""The number of variants that play each motion by default."""

ProgressHook = Callable[[int, int, str], None]
"""A function called with the number of finished performances, the total number, and the motion's name."""


def played(
    found: Findings,
    wanted: Callable[[Diagnostic], bool],
    robots: int,
    tell: ProgressHook = lambda *_: None,
    *,
    keep: bool = True,
    imperfections: Imperfections | None = None,
    workers: Workers | None = None,
) -> tuple[Findings, list[CaseResult]]:
    """Return a project's findings, including those of its simulated motions, and the results.

    Only motions in the requested files are played, and none if the project has errors. With `keep`, outcomes are kept,
    and only motions without a known outcome are played. `imperfections` replace the project's. `workers` share the
    work; the default is this process. Raises MissingExtraError if the simulation is not installed, or WorkersError if
    the workers fail.
    """
    root = Path(found.root)
    project = check_files(root, found.files)[0]
    if project is None:
        return found, []
    demand("simulation", "--physics", "mujoco", "dm_control")
    if imperfections:
        project = project.with_section("imperfections", imperfections)
    every = cases(project)
    chosen = [number for number, case in enumerate(every) if not found.asked or case.file in found.asked]
    memory = OutcomeCache(project, found.files) if keep else None
    known = {number: memory.recall(every[number]) if memory else {} for number in chosen}
    kit = WorkKit({"": found.files}, models_in(root))
    for number, robot, outcome in _play(workers or Workers(), kit, project, known, robots, tell):
        known[number][robot] = outcome
        if memory:
            memory.keep(every[number], known[number])
    rehearsals = [CaseResult(every[n], [known[n][robot] for robot in range(robots + 1)]) for n in chosen]
    more = [d for r in rehearsals for d in findings(r, project.documents[r.case.file], project.body) if wanted(d)]
    everything = sorted([*found.diagnostics, *dict.fromkeys(more)], key=lambda d: (d.place.file, d.place.line))
    return replace(found, diagnostics=everything), rehearsals


def play_case(kit: UnpackedKit, case: int, robot: int, imperfections: Imperfections) -> Outcome:
    """Play the case with this index in the project on the robot with this number; return the outcome.

    This is a task for workers.
    """
    from lumen.features.simulation.subject import subject

    project = kit.project()
    assert project is not None  # the sender of the task has loaded it
    models, hall = model_files(project)
    simulated = subject(project.body, models, hall, robot, imperfections)
    try:
        return attempt(cases(project)[case], simulated)
    finally:
        simulated.close()


def _play(
    workers: Workers,
    kit: WorkKit,
    project: Project,
    known: Mapping[int, Mapping[int, Outcome]],
    robots: int,
    tell: ProgressHook,
) -> Iterator[tuple[int, int, Outcome]]:
    """Yield the case's index, the robot's number and the outcome of each unknown outcome as it arrives.

    The work is ordered by robot, since each robot has its own model to compile.
    """
    every = cases(project)
    tasks = [
        (case, robot, project.section(Imperfections))
        for robot in range(robots + 1)
        for case, outcomes in known.items()
        if robot not in outcomes
    ]
    if not tasks:
        return
    tell(0, len(tasks), every[tasks[0][0]].motion.name)
    with closing(workers.results(play_case, kit, tasks)) as results:
        for done, (number, outcome) in enumerate(results, 1):
            case, robot, _ = tasks[number]
            tell(done, len(tasks), every[case].motion.name)
            yield case, robot, outcome


def summary(rehearsals: Sequence[CaseResult]) -> str:
    """Return a line for each case: the number of robots that succeeded, the torso's lean, and the feet's slide."""
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
    """Return the number in `--robots N`. Raises UsageError unless it is an integer from 0 to 1000."""
    number = int(text) if text.isdecimal() and text.isascii() and len(text) < 10 else inf
    if number > 1000:
        raise UsageError(f"--robots must be a number from 0 to 1000, not `{text[:40]}`")
    return int(number)
