"""Checks of values that robots share: which behaviour can assign them, and whether their names are free."""

from collections.abc import Iterator

from lumen.expressions.expression_findings import UNKNOWN_CONTEXT_KEY
from lumen.language.actions import Assign, Send
from lumen.language.diagnostics import ERROR, Code, NodePath, did_you_mean
from lumen.language.machines import MachineDefinition
from lumen.language.shared import SHARED, SHARED_EVENT, SharedKeys
from lumen.lint.walk import action_sites
from lumen.project.draft import ProjectDraft

NOT_OWNER = Code("not-owner", "robot", ERROR, "a robot assigns a key of `shared` that belongs to another robot")
SHARED_TAKEN = Code(
    "shared-taken",
    "robot",
    ERROR,
    "the context of a behaviour has a key `shared`, which hides the `shared` of the house",
)
MAKES_SHARED_EVENT = Code(
    "makes-shared-event", "robot", ERROR, "a route or a `send` uses the event that updates `shared`"
)


def check(draft: ProjectDraft) -> None:
    """Report assignments of keys that belong to other robots, and uses of reserved names."""
    settings = draft.settings
    _made(draft)
    machine = draft.behaviors.get(settings.behavior) if settings else None
    if settings is None or machine is None:
        return
    keys = settings.section(SharedKeys).by_name
    if not keys:
        return
    report = draft.report("behaviors", settings.behavior)
    if SHARED in (report.document.data.get("context") or {}):
        hint = "rename it: `shared` holds the values from lumen.yaml for all robots"
        report(SHARED_TAKEN, ("context", SHARED), "this key hides the `shared` of the house", hint, key=True)
        return
    for way, where in _assigned(machine):
        key = way.partition(".")[2]
        if key not in keys:
            message = f"`shared` has no `{key}`" if key else "`shared` can't be assigned as a whole"
            hint = did_you_mean(f"{SHARED}.{key}", [f"{SHARED}.{name}" for name in keys], "lumen.yaml has")
            report(UNKNOWN_CONTEXT_KEY, where, message, hint, key=True)
        elif (owner := keys[key].owner) != settings.robot:
            hint = f"assign it in the behaviour of `{owner}`, and request that with `send: {{to: {owner}, event: …}}`"
            report(NOT_OWNER, where, f"`{key}` belongs to `{owner}`, but `{settings.robot}` assigns it", hint, key=True)


def _made(draft: ProjectDraft) -> None:
    """Report other uses of the event that updates `shared`: they could change any key, bypassing its owner."""
    message = f"the event `{SHARED_EVENT}` would change keys of `shared` without their owners"
    hint = "use another event: only the owner of a key can assign it"
    if draft.settings and draft.main:
        for route in draft.settings.routes.values():
            if route.event == SHARED_EVENT:
                draft.main(MAKES_SHARED_EVENT, (*route.where, "event"), message, hint)
    for name, machine in draft.behaviors.items():
        for site in action_sites(machine):
            if isinstance(site.step.action, Send) and site.step.action.event == SHARED_EVENT:
                draft.report("behaviors", name)(MAKES_SHARED_EVENT, (*site.step.where, "send"), message, hint)


def _assigned(machine: MachineDefinition) -> Iterator[tuple[str, NodePath]]:
    """Yield the keys of `shared` that a behaviour assigns, with their paths."""
    for site in action_sites(machine):
        if isinstance(site.step.action, Assign):
            for way in site.step.action.values:
                if way.partition(".")[0] == SHARED:
                    yield way, (*site.step.where, "assign", way)
