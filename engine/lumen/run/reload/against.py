"""Findings about what a reload from another version of a project would refuse, move or forget."""

from collections.abc import Callable, Iterator

from lumen.insight.changes import live
from lumen.insight.migration import Refusal
from lumen.insight.migration.placing import Identity
from lumen.language.diagnostics import Code, Diagnostic, NodePath, Place
from lumen.language.machines import MachineDefinition
from lumen.language.projects import Project
from lumen.lint.on_request import RELOAD_FORGETS, RELOAD_MOVES, RELOAD_REFUSED
from lumen.run.reload.migration_preview import MigrationPreview, preview
from lumen.statechart.type_checks import type_checks, type_name

BOUND = 10_000
"""Configurations of the old behaviour that are explored at most."""


def against(old: Project, new: Project, tell: Callable[[int, int], None] = lambda *_: None) -> list[Diagnostic]:
    """Return the findings, each once, by place, for every reachable configuration of the old behaviour.

    `tell` is called with how many configurations were explored, and how many are known.
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
    """Yield the moves away from states that no longer exist, at the `onReload` that orders them."""
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
    """Return the place of the `onReload` for a state that no longer exists; None if it exists, or has none."""
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
