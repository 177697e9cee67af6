"""Findings about what a reload from another version of a project would refuse, move or forget."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

from lumen.insight.changes import live
from lumen.insight.exploration.search import StateSpaceSearch, leaves
from lumen.insight.migration import MigrationDelay, MigrationPlan, MigrationVerdict, Refusal, plan
from lumen.insight.migration.placing import Identity
from lumen.language.diagnostics import Code, Diagnostic, NodePath, Place
from lumen.language.machines import MachineDefinition
from lumen.language.projects import Project
from lumen.lint.on_request import RELOAD_FORGETS, RELOAD_MOVES, RELOAD_REFUSED
from lumen.run.exploring import outside
from lumen.run.story_time import story_epoch
from lumen.statechart import Snapshot
from lumen.statechart.type_checks import type_checks, type_name


@dataclass(frozen=True)
class MigrationOutcome:
    """The outcome of a reload in certain innermost states."""

    states: tuple[str, ...]
    """The innermost active states before the reload."""
    outcome: str
    """`kept`, `moved`, `waits` or `refused`."""
    told: str
    """Notes, or the reason why the reload waits or is refused."""
    after: tuple[str, ...]
    """The innermost active states afterwards."""
    verdict: MigrationVerdict
    """The plan, delay or refusal itself."""
    count: int = 1
    """The number of configurations with this outcome."""


@dataclass(frozen=True)
class MigrationPreview:
    """The outcomes in all explored configurations."""

    rows: tuple[MigrationOutcome, ...]
    configurations: int
    """The number of configurations found."""
    waiting: int
    """The number of configurations that were not explored, because of the bound."""


def preview(old: Project, new: Project, bound: int, tell: Callable[[int, int], None]) -> MigrationPreview:
    """Return the outcome in every reachable configuration of the old behaviour; equal outcomes are counted together.

    `bound` limits the exploration; `tell` is called with the numbers of configurations that were explored and that
    wait.
    """
    machine = old.machine
    language, epoch = old.languages[0], story_epoch(None, old.timezone)
    search = StateSpaceSearch(machine, outside(old, machine), language=language, epoch=epoch, timezone=old.timezone)
    for explored in search.expand(bound):
        tell(explored, search.waiting)
    found: dict[tuple[object, ...], MigrationOutcome] = {}
    for node in search.nodes.values():
        fate = outcome_of(old, new, node.snapshot)
        key = (fate.states, fate.outcome, fate.told, fate.after)
        found[key] = replace(fate, count=found[key].count + 1 if key in found else 1)
    order = ("refused", "waits", "moved", "kept")
    rows = sorted(found.values(), key=lambda fate: order.index(fate.outcome))
    return MigrationPreview(tuple(rows), len(search.nodes), search.waiting)


def outcome_of(old: Project, new: Project, snapshot: Snapshot) -> MigrationOutcome:
    """Return the outcome of a reload from a snapshot."""
    verdict = plan(old, new, snapshot, at=snapshot.at)
    before = _inner(old, snapshot)
    if isinstance(verdict, MigrationPlan):
        after = _inner(new, verdict.snapshot)
        outcome = "moved" if verdict.exited or verdict.entered else "kept"
        return MigrationOutcome(before, outcome, "; ".join(verdict.notes), after, verdict)
    if isinstance(verdict, MigrationDelay):
        return MigrationOutcome(before, "waits", verdict.reason, (), verdict)
    return MigrationOutcome(before, "refused", verdict.reason, (), verdict)


def _inner(project: Project, snapshot: Snapshot) -> tuple[str, ...]:
    machine = project.machine
    return tuple(machine.states[path].name for path in leaves(machine, snapshot.configuration))


BOUND = 10_000
"""The greatest number of configurations of the old behaviour that are explored."""


def against(old: Project, new: Project, tell: Callable[[int, int], None] = lambda *_: None) -> list[Diagnostic]:
    """Return the findings, each once, sorted by place, for up to BOUND reachable configurations of the old behaviour.

    `tell` is called with the numbers of configurations that were explored and that wait.
    """
    if old.machine == new.machine:
        return []
    everywhere = preview(old, live(old, new), BOUND, tell)
    found = [*_refused(new, everywhere), *_moved(old, new, everywhere), *_forgotten(old, new)]
    return sorted(dict.fromkeys(found), key=lambda d: (d.place, d.code, d.message))


def _refused(new: Project, everywhere: MigrationPreview) -> Iterator[Diagnostic]:
    for verdict in (fate.verdict for fate in everywhere.rows):
        if isinstance(verdict, Refusal):
            place = _place(new, verdict.behavior, (*verdict.where, "states"))
            message = f"a reload would be refused: {verdict.reason}"
            yield _finding(RELOAD_REFUSED, message, place, verdict.hint)


def _moved(old: Project, new: Project, everywhere: MigrationPreview) -> Iterator[Diagnostic]:
    """Yield the moves away from states that no longer exist, at the `onReload` that directs them."""
    identity = Identity(old.machine, new.machine)
    for fate in everywhere.rows:
        if fate.outcome != "moved":
            continue
        names = {state.name: path for path, state in old.machine.states.items()}
        for name in fate.states:
            if (where := _says(old.machine, new.machine, identity, names[name])) is not None:
                place = _place(new, new.behavior, where)
                goals = ", ".join(f"`{state}`" for state in fate.after if state not in fate.states)
                message = f"a reload would move from `{name}`, which no longer exists, to {goals}"
                hint = f"if `{name}` has a new name, write it under `renamed`"
                yield _finding(RELOAD_MOVES, message, place, hint)


def _says(old: MachineDefinition, new: MachineDefinition, identity: Identity, path: str) -> NodePath | None:
    """Return the place of the `onReload` for a removed state; None if it exists, or no `onReload` applies."""
    if identity.state(path) is not None:
        return None
    around: str | None = path
    while around and identity.state(around) is None:
        around = old.states[around].parent
    here: str | None = identity.state(around) if around else ""
    while here is not None and not new.states[here].on_reload:
        here = new.states[here].parent
    return None if here is None else (*new.states[here].where, "onReload")


def _forgotten(old: Project, new: Project) -> Iterator[Diagnostic]:
    """Yield the keys whose values a reload would lose."""
    before, after = old.machine, new.machine
    was, checks, hint = (
        Identity(before, after).keys(),
        type_checks(after),
        "if the key has a new name, write it under `renamed`",
    )
    for key in before.context:
        if key not in was.values():
            message = f"a reload would lose the value of `{key}`"
            yield _finding(RELOAD_FORGETS, message, _place(new, new.behavior, ("context",)), hint)
    for key, name in was.items():
        check = checks[key]
        if name in before.context and check and not check.accepts(before.context[name]):
            place = _place(new, new.behavior, ("context", key))
            was_type = type_name(before.context[name])
            message = f"a reload would lose the value of `{key}`: it is a {was_type}, but must now be {check}"
            yield _finding(RELOAD_FORGETS, message, place, "let `types` allow both")


def _place(project: Project, behavior: str, where: NodePath) -> Place:
    file = f"behaviors/{behavior}.yaml"
    document = project.documents.get(file)
    return document.place(where, key=True) if document else Place(file)


def _finding(code: Code, message: str, place: Place, hint: str) -> Diagnostic:
    return code.at(place, message, hint)
