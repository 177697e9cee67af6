"""The uses of names in a project's files, and the kinds of things that they name."""

from enum import StrEnum
from typing import NamedTuple

from lumen.language.diagnostics import Place
from lumen.language.folders import FUNCTIONS_FOLDER
from lumen.project.project_folders import (
    BEHAVIORS,
    CONTROLLERS,
    MESSAGES,
    MODELS,
    MOTIONS,
    SKILLS,
    STORIES,
    WORDS_FOLDER,
)


class NameKind(StrEnum):
    """The kinds of things that names refer to; `EXPRESSION`, `TEMPLATE`, `FIELD` and `ROW` contain other names."""

    STATE = "state"
    CONTEXT = "context key"
    PHRASE = "phrase"
    ANSWERS = "answers table"
    EVENT = "event"
    ROUTE = "route"
    MESSAGE = "message schema"
    MOTION = "motion"
    POSE = "pose"
    POSTURE = "posture"
    CONTROLLER = "controller"
    BEHAVIOR = "behaviour"
    WORDS = "words file"
    FUNCTION = "function"
    STORY = "story"
    MODEL = "robot"
    SKILL = "skill"
    JOINT = "joint"
    SENSOR = "sensor"
    LANGUAGE = "language"
    PLACE = "place"
    EXPRESSION = "expression"
    TEMPLATE = "text"
    FIELD = "field"
    ROW = "row"


KIND_FOLDERS = {
    NameKind.BEHAVIOR: BEHAVIORS,
    NameKind.WORDS: WORDS_FOLDER,
    NameKind.FUNCTION: FUNCTIONS_FOLDER,
    NameKind.STORY: STORIES,
    NameKind.MOTION: MOTIONS,
    NameKind.CONTROLLER: CONTROLLERS,
    NameKind.MODEL: MODELS,
    NameKind.MESSAGE: MESSAGES,
    NameKind.SKILL: SKILLS,
}
"""The kinds that are files, with their folders."""

SCOPED_KINDS = frozenset((NameKind.STATE, NameKind.CONTEXT, NameKind.PHRASE, NameKind.ANSWERS, NameKind.POSE))
"""The kinds whose names are valid within one file only."""

BODY_KINDS = frozenset((NameKind.JOINT, NameKind.POSTURE))
"""The kinds whose names belong to one robot's body."""


class NameUse(NamedTuple):
    """A use of a name."""

    kind: NameKind
    scope: str
    """The behaviour or file in which the name is valid; empty for the whole project."""
    name: str
    """The thing's name; for a state its path, however it is written."""
    text: str
    """The name as it is written; empty if it is not written in the project."""
    place: Place
    defines: bool = False
    """True if this use defines the thing."""

    @property
    def thing(self) -> tuple[NameKind, str, str]:
        """The kind, scope and name of the thing, which all uses of its name share."""
        return self.kind, self.scope, self.name


def covers(place: Place, line: int, column: int) -> bool:
    """Return True if a cursor at that line and column, from 1, is in the place or directly behind it."""
    return (place.line, place.column) <= (line, column) <= (place.end_line, place.end_column)
