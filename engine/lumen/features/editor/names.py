"""The kinds of names in a project's files, and their uses."""

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
    """The kinds of names; `EXPRESSION`, `TEMPLATE`, `FIELD` and `ROW` are texts that contain other names."""

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
"""The kinds of names that files define, with the files' folders."""

SCOPED_KINDS = frozenset((NameKind.STATE, NameKind.CONTEXT, NameKind.PHRASE, NameKind.ANSWERS, NameKind.POSE))
"""The kinds whose names are valid only in the scope of one file."""

BODY_KINDS = frozenset((NameKind.JOINT, NameKind.POSTURE))
"""The kinds whose names belong to one robot's body."""


class NameUse(NamedTuple):
    """A use or definition of a name."""

    kind: NameKind
    scope: str
    """The behaviour or file in which the name is valid; empty for the whole project."""
    name: str
    """The name itself; for a state its path, however it is written."""
    text: str
    """The name as it is written; empty if it is not written in the project."""
    place: Place
    defines: bool = False
    """True if this use is a definition."""

    @property
    def thing(self) -> tuple[NameKind, str, str]:
        """The kind, scope and name, which all uses with the same meaning share."""
        return self.kind, self.scope, self.name


def covers(place: Place, line: int, column: int) -> bool:
    """Return True if a cursor at a line and column, from 1, is in the place or directly after it."""
    return (place.line, place.column) <= (line, column) <= (place.end_line, place.end_column)
