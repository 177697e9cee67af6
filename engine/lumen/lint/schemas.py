"""Checks the JSON Schemas of context keys and events in behaviours, and the context's initial values."""

from lumen.project.context import check_memory
from lumen.project.draft import ProjectDraft


def check(draft: ProjectDraft) -> None:
    """Report faults under `context:`, `types:` and `events:`."""
    for name, machine in draft.behaviors.items():
        unsound = check_memory(machine, draft.report("behaviors", name))
        draft.unsound.update((name, part, key) for part, key in unsound)
