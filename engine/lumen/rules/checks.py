"""The rules, in the order in which they look at a project."""

from types import ModuleType

from lumen.rules import (
    after_end,
    alerts,
    clock_texts,
    controllers,
    dead_ends,
    effects,
    events,
    expressions,
    guards,
    lists,
    models,
    motions,
    places,
    recipients,
    references,
    renaming,
    routes,
    schemas,
    show,
    signals,
    speech,
    statecharts,
    stories,
    timing,
    traps,
    units,
    unused,
    ways,
)

CHECKS: tuple[ModuleType, ...] = (
    traps,
    schemas,
    references,
    recipients,
    models,
    expressions,
    events,
    routes,
    show,
    alerts,
    speech,
    lists,
    signals,
    controllers,
    motions,
    units,
    places,
    ways,
    clock_texts,
    guards,
    statecharts,
    after_end,
    dead_ends,
    timing,
    stories,
    renaming,
    effects,
    unused,
)
"""Each has a `check(draft)` that reports what it finds.

What is unused or never reached is looked for where nothing else is wrong.
"""
