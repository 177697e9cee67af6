"""A difference between two bundles, in words for the people who edit the files."""

from dataclasses import dataclass, field
from enum import IntEnum

from lumen.language.diagnostics import NodePath


class Risk(IntEnum):
    """The reach of a change in a running exhibition; a greater risk includes the effects of the smaller ones."""

    COSMETIC = 0
    """Texts, stories, names: the same things happen."""
    BEHAVIOR = 1
    """States, transitions, guards, context, controllers: something else happens."""
    MOTION = 2
    """Keyframes and head control: the robot moves differently."""
    WIRING = 3
    """Routes and message schemas: other modules have to fit."""
    RESTART = 4
    """The robot's model, the hall, the stage, the broker: takes effect only at the next start."""

    def __str__(self) -> str:
        return self.name.lower()


@dataclass(frozen=True, slots=True)
class Change:
    """One difference; two changes are equal if their kinds, subjects, sentences, risks and files are."""

    kind: str
    """The kind of part that changed: `text`, `state`, `route`, …"""
    about: str
    """The name of what changed."""
    sentence: str
    """The change in words."""
    risk: Risk
    """Its reach in a running exhibition."""
    file: str = ""
    """Its file, relative to the project."""
    where: NodePath = field(default=(), compare=False)
    """The path of the node in that file; empty if unknown."""
    was: str = field(default="", compare=False)
    """The whole text before the change; empty if the change is not about a text."""
    now: str = field(default="", compare=False)
    """The whole text after the change."""

    def __str__(self) -> str:
        return self.sentence
