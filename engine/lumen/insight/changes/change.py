"""A difference between two bundles, in the words of whoever edits the files."""

from dataclasses import dataclass, field
from enum import IntEnum

from lumen.language.diagnostics import NodePath


class Risk(IntEnum):
    """How much of a running exhibition a change can touch; a greater one may do all that a smaller one does."""

    COSMETIC = 0
    """Texts, stories, names: the same things happen."""
    BEHAVIOR = 1
    """States, transitions, guards, context, controllers: something else happens."""
    MOTION = 2
    """Keyframes and head control: the robot moves differently."""
    WIRING = 3
    """Routes and message schemas: other modules have to fit."""
    RESTART = 4
    """The robot's model, the hall, the stage, the broker: active only when the exhibition is started anew."""

    def __str__(self) -> str:
        return self.name.lower()


@dataclass(frozen=True, slots=True)
class Change:
    """One difference: what `kind` it is (`text`, `state`, `route`, …), what it is `about`, a sentence, and its risk.

    `file` is its file, relative to the project, `where` the place in it; `was` and `now` are a text that
    changed, whole. Two changes are equal if their sentences, files and risks are.
    """

    kind: str
    about: str
    sentence: str
    risk: Risk
    file: str = ""
    where: NodePath = field(default=(), compare=False)
    was: str = field(default="", compare=False)
    now: str = field(default="", compare=False)

    def __str__(self) -> str:
        return self.sentence
