"""The changes between two projects, part by part, and a summary in one line."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields, replace
from itertools import groupby
from typing import Any

from lumen.feature import VerbRow
from lumen.insight.changes.change import Change, Risk, code, entry_changes, how_many
from lumen.insight.changes.machines import machine_changes
from lumen.insight.changes.parts import controller_changes, function_changes, motion_changes, route_changes
from lumen.insight.changes.sections import AT_NEXT_START, RESTART_FIELDS, section_changes
from lumen.language.projects import Project

MAX_SUMMARY_CHANGES = 4
"""Up to this number, a summary names each change; beyond it, a kind with more than two changes is only counted."""

_SHARED_MOVEMENTS = ("gestures", "life")
"""The folders in motions/ for all robots; every other folder is named after a robot's model."""
_SELF = ("root", "hash", "documents", "told_apart")
"""Fields that are not settings: they describe the files, or follow from `robots`."""


def changes(old: Project, new: Project) -> tuple[Change, ...]:
    """Return the differences in meaning, in the order of the files; empty if only comments or the layout differ.

    A change of a words file is returned once, however many behaviours use it.
    """
    return tuple(dict.fromkeys(_changes(old, new)))


def change_data(change: Change, new: Project) -> dict[str, Any]:
    """Return a change as JSON data: `file`, `line` in the new files (None if unknown), the texts `was` and `now`."""
    known = bool(change.where) and change.file in new.documents
    line = new.place(change.file, change.where).line if known else None
    return {"file": change.file, "line": line, "was": change.was, "now": change.now}


def risk(found: Sequence[Change]) -> Risk:
    """Return the greatest risk among the changes; COSMETIC if there are none."""
    return max((change.risk for change in found), default=Risk.COSMETIC)


def summary(found: Sequence[Change]) -> str:
    """Return all changes as one line; texts, kinds with many changes, and the rest of a long line are only counted."""
    parts: list[str] = []
    for kind, group in groupby(sorted(found, key=lambda change: change.kind), lambda change: change.kind):
        rows = list(group)
        if kind == "text" or (len(found) > MAX_SUMMARY_CHANGES and len(rows) > 2):
            parts.append(f"{how_many(len(rows), kind)} changed")
        else:
            parts += [change.sentence for change in rows]
    if len(parts) > 2 * MAX_SUMMARY_CHANGES:
        parts = [*parts[: 2 * MAX_SUMMARY_CHANGES], f"{how_many(len(parts) - 2 * MAX_SUMMARY_CHANGES, 'more change')}"]
    return "; ".join(parts) or "no relevant changes"


def _changes(old: Project, new: Project) -> Iterator[Change]:
    yield from _settings(old, new)
    yield from entry_changes(
        "behavior",
        "behaviour",
        Risk.BEHAVIOR,
        "behaviors/{}.yaml",
        {name: (name, machine) for name, machine in old.behaviors.items()},
        {name: (name, machine) for name, machine in new.behaviors.items()},
        lambda before, after: machine_changes(after[0], before[1], after[1]),
    )
    yield from entry_changes("skill", "skill", Risk.BEHAVIOR, "skills/{}.yaml", _manifests(old), _manifests(new))
    yield from entry_changes(
        "function", "function", Risk.BEHAVIOR, "functions/{}.yaml", old.functions, new.functions, function_changes
    )
    yield from entry_changes(
        "controller", "controller", Risk.MOTION, "fuzzy/{}.yaml", old.controllers, new.controllers, controller_changes
    )
    for found in _movements(old, new):
        yield replace(found, file=_file_of_movement(found, new) or _file_of_movement(found, old) or found.file)
    for found in entry_changes("route", "route", Risk.WIRING, "lumen.yaml", old.routes, new.routes, route_changes):
        uses = (new.routes.get(found.about) or old.routes[found.about]).uses
        yield replace(found, file=uses[0].file) if uses else found
    yield from section_changes(old, new, lambda row: bool(row.entries))
    files = {name: passage.file for each in (old, new) for name, passage in each.knowledge.items()}
    for found in entry_changes("passage", "passage", Risk.COSMETIC, "{}", old.knowledge, new.knowledge):
        yield replace(found, file=files[found.about])
    asked = "set of questions", Risk.BEHAVIOR, "knowledge/questions/{}.yaml"
    yield from entry_changes("questions", *asked, old.questions, new.questions)
    yield from entry_changes(
        "message", "message", Risk.WIRING, "schemas/messages/{}.schema.json", old.messages, new.messages
    )
    yield from entry_changes("story", "story", Risk.COSMETIC, "behaviors/stories/{}.yaml", old.stories, new.stories)
    tried = "file of sayings", Risk.COSMETIC, "behaviors/sayings/{}.yaml"
    yield from entry_changes("sayings", *tried, old.sayings, new.sayings)


def _movements(old: Project, new: Project) -> Iterator[Change]:
    """Yield the changes of motions, gestures and styles of life, each with the file for all robots."""
    yield from entry_changes(
        "motion", "motion", Risk.MOTION, "motions/{}.yaml", old.motions, new.motions, motion_changes
    )
    libraries = old.gestures, new.gestures
    yield from entry_changes("gestures", "library of gestures", Risk.MOTION, "motions/gestures/{}.yaml", *libraries)
    yield from entry_changes("life", "style of life", Risk.MOTION, "motions/life/{}.yaml", old.life, new.life)


def _file_of_movement(change: Change, project: Project) -> str:
    """Return a change's file: in the robot's own folder, else in the folder for all robots; empty if neither exists.

    The project contains no other robot's files.
    """
    inside = [f"{change.about}.yaml"] if change.kind == "motion" else [change.kind, f"{change.about}.yaml"]
    for file in project.documents:
        motions, _, rest = file.partition("/")
        model, *own = rest.split("/")
        if motions == "motions" and own == inside and model not in _SHARED_MOVEMENTS:
            return file
    return change.file if change.file in project.documents else ""


def _manifests(project: Project) -> dict[str, VerbRow]:
    """Return the verbs that a project's files declare, without the folder and the robot, which no file declares."""
    return {name: row._replace(root="", robot="") for name, row in project.verbs.items()}


def _settings(old: Project, new: Project) -> Iterator[Change]:
    """Yield the changes in lumen.yaml, except those of routes and of sections with entries."""
    for name, title in RESTART_FIELDS.items():
        if getattr(old, name) != getattr(new, name):
            yield Change("fixed", name, f"{title} changed: {AT_NEXT_START}", Risk.RESTART, "lumen.yaml")
    yield from section_changes(old, new, lambda row: row.fixed and not row.entries)
    for language in dict.fromkeys((*old.languages, *new.languages)):
        if (language in old.languages) != (language in new.languages):
            how = "added" if language in new.languages else "removed"
            yield Change("language", language, f"language `{language}` {how}", Risk.BEHAVIOR, "lumen.yaml")
    if old.languages[:1] != new.languages[:1]:
        yield Change("language", "", f"`{new.languages[0]}` is now the first language", Risk.BEHAVIOR, "lumen.yaml")
    yield from section_changes(old, new, lambda row: not (row.fixed or row.entries))
    for field in (f.name for f in fields(Project) if f.name not in (*RESTART_FIELDS, *_SELF, "languages")):
        before, after = getattr(old, field), getattr(new, field)
        if before != after and not isinstance(after, Mapping):
            risk = Risk.BEHAVIOR if field == "behavior" else Risk.COSMETIC
            yield Change("setting", field, f"`{field}` is now {code(after)}, not {code(before)}", risk, "lumen.yaml")
    yield from _robots(old, new)


def _robots(old: Project, new: Project) -> Iterator[Change]:
    """Yield the changes of `robots:` that no other setting shows.

    Another robot's entry is only named: its settings change when that robot reloads them.
    """
    own = old.robots.get(old.robot), new.robots.get(new.robot)
    for name in ("at", "driver"):
        if getattr(own[0], name, None) != getattr(own[1], name, None):
            sentence = f"`{name}` of robot `{new.robot}` changed: {AT_NEXT_START}"
            yield Change("fixed", name, sentence, Risk.RESTART, "lumen.yaml")
    before, after = ({name: spec for name, spec in each.robots.items() if name != each.robot} for each in (old, new))
    for found in entry_changes("robot", "robot", Risk.COSMETIC, "lumen.yaml", before, after):
        if found.about in before and found.about in after:
            yield found
        else:
            yield replace(found, sentence=f"{found.sentence}: {AT_NEXT_START}", risk=Risk.RESTART)
