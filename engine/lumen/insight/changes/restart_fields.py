"""The settings of a project that can't change while it runs."""

from collections.abc import Mapping
from dataclasses import replace

from lumen.insight.changes.sections import live_sections
from lumen.language.projects import Project

RESTART_FIELDS: Mapping[str, str] = {
    "robot": "the robot's name",
    "body": "the robot's model",
    "hall": "the hall",
    "stage": "the stage",
    "bus": "the broker's address",
    "modules": "the settings of the modules",
}
"""Fields of `Project` that take effect only at the next start, with their names for people."""


def live(old: Project, new: Project) -> Project:
    """Return the new bundle, but with the old values of everything that needs a restart, such as `RESTART_FIELDS`."""
    fixed = {name: getattr(old, name) for name in RESTART_FIELDS}
    return replace(new, **fixed, sections=live_sections(old, new))
