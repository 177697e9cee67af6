"""The changes in the sections of lumen.yaml that features add."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import fields, is_dataclass, replace
from typing import Any

from lumen.feature import Section, table
from lumen.insight.changes.change import Change, Risk, code, entry_changes
from lumen.language.projects import Project

AT_NEXT_START = "it takes effect at the next start"
MAIN_FILE = "lumen.yaml"


def section_changes(old: Project, new: Project, among: Callable[[Section], bool]) -> Iterator[Change]:
    """Yield the changes of the sections whose row in the table of sections `among` accepts."""
    for key, row in table("sections").items():
        before, after = _both(old, new, key)
        if before == after or not among(row):
            continue
        risk = Risk[row.risk.upper()]
        if row.entries:
            named = _entries(before, row), _entries(after, row)
            yield from entry_changes(row.title, row.title, risk, MAIN_FILE, *named)
            if _without(before, row) != _without(after, row):
                yield Change("setting", key, f"`{key}` changed", risk, MAIN_FILE)
        elif row.fixed:
            yield Change("fixed", key, f"{row.title} changed: {AT_NEXT_START}", risk, MAIN_FILE)
        elif row.title:
            yield Change(key.rpartition(".")[2], "", f"{row.title} changed", risk, MAIN_FILE)
        elif not is_dataclass(after):
            yield Change("setting", key, f"`{key}` changed", risk, MAIN_FILE)
        else:
            for name in (one.name for one in fields(after)):
                was, now = getattr(before, name), getattr(after, name)
                if was != now:
                    about = f"{key}.{name}"
                    yield Change("setting", about, f"`{about}` is now {code(now)}, not {code(was)}", risk, MAIN_FILE)


def live_sections(old: Project, new: Project) -> dict[str, object]:
    """Return the new sections; those that take effect only at the next start keep their old values."""
    fixed = {key for key, row in table("sections").items() if row.fixed}
    kept = {key: settings for key, settings in old.sections.items() if key in fixed}
    return {**{key: settings for key, settings in new.sections.items() if key not in fixed}, **kept}


def _both(old: Project, new: Project, key: str) -> tuple[Any, Any]:
    """Return a section of the old and of the new project.

    A project that lacks the section has its defaults; if both projects lack it, both values are None.
    """
    before, after = old.sections.get(key), new.sections.get(key)
    if before is None and after is not None:
        before = type(after)()
    elif after is None and before is not None:
        after = type(before)()
    return before, after


def _entries(settings: object, row: Section) -> Mapping[str, object]:
    entries: Mapping[str, object] = getattr(settings, row.entries)
    return entries


def _without(settings: Any, row: Section) -> Any:
    """Return the settings without their entries."""
    return replace(settings, **{row.entries: {}})


RESTART_FIELDS: Mapping[str, str] = {
    "robot": "the robot's name",
    "body": "the robot's model",
    "hall": "the hall",
    "stage": "the stage",
    "bus": "the broker's address",
    "modules": "the settings of the modules",
}
"""Fields of `Project` whose changes take effect only at the next start, with their names in messages."""


def live(old: Project, new: Project) -> Project:
    """Return the new bundle with the old values of everything that needs a restart, such as `RESTART_FIELDS`."""
    fixed = {name: getattr(old, name) for name in RESTART_FIELDS}
    verbs = {name: row._replace(robot=old.robot) for name, row in new.verbs.items()}
    return replace(new, **fixed, verbs=verbs, sections=live_sections(old, new))
