"""What of a project can't change while it runs."""

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
"""Fields of `Project` that are active only from the next start on, and what they are called."""


def live(old: Project, new: Project) -> Project:
    """The new bundle as far as it can be active at once: the rest, such as `RESTART_FIELDS`, is as in the old one."""
    fixed = {name: getattr(old, name) for name in RESTART_FIELDS}
    return replace(new, **fixed, sections=live_sections(old, new))
