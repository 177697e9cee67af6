"""The changes between two projects, part by part, and all of them in one line."""

from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby
from typing import Any

from lumen.interpreters.changes.change import Change, Risk
from lumen.interpreters.changes.fixed import FIXED
from lumen.language.projects import Project

MOST = 6
"""Changes that a summary names."""


def changes(old: Project, new: Project) -> tuple[Change, ...]:
    """What differs in meaning, in the order of the files; nothing where only comments or the layout do."""
    return tuple(_changes(old, new))


def risk(found: Sequence[Change]) -> Risk:
    """The greatest risk among the changes."""
    return max((change.risk for change in found), default=Risk.COSMETIC)


def summary(found: Sequence[Change]) -> str:
    """All changes in one line: those of one kind counted where they are many, texts always."""
    parts: list[str] = []
    for kind, group in groupby(sorted(found, key=lambda change: change.kind == "text"), lambda change: change.kind):
        rows = list(group)
        if kind == "text":
            parts.append(f"{len(rows)} text{'s' * (len(rows) > 1)} changed")
        else:
            parts += [change.sentence for change in rows]
    if len(parts) > MOST:
        parts = [*parts[: MOST - 1], f"{len(parts) - MOST + 1} more changes"]
    return "; ".join(parts) or "nothing that matters changed"


def _changes(old: Project, new: Project) -> Iterator[Change]:
    yield from _named("behavior", "behaviour", old.behaviors, new.behaviors, Risk.BEHAVIOR)
    yield from _named("controller", "controller", old.controllers, new.controllers, Risk.MOTION)
    yield from _named("motion", "motion", old.motions, new.motions, Risk.MOTION)
    yield from _named("route", "route", old.routes, new.routes, Risk.WIRING)
    yield from _named("message", "message", old.messages, new.messages, Risk.WIRING)
    yield from _named("story", "story", old.stories, new.stories, Risk.COSMETIC)
    for name, title in FIXED.items():
        if getattr(old, name) != getattr(new, name):
            yield Change("fixed", name, f"{title} changed: in force from the next start on", Risk.RESTART)


def _named(kind: str, title: str, old: Mapping[str, Any], new: Mapping[str, Any], risk: Risk) -> Iterator[Change]:
    for name in dict.fromkeys((*old, *new)):
        if old.get(name) != new.get(name):
            how = "added" if name not in old else "removed" if name not in new else "changed"
            yield Change(kind, name, f"{title} `{name}` {how}", risk)
