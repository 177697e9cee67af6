"""A name in somebody's file: what sort of thing it names, which one, and where exactly it stands."""

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
    """What a name can stand for; `EXPRESSION`, `TEMPLATE`, `FIELD` and `ROW` hold other names."""

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
"""The kinds that are files, and where those are."""

SCOPED_KINDS = frozenset((NameKind.STATE, NameKind.CONTEXT, NameKind.PHRASE, NameKind.ANSWERS, NameKind.POSE))
"""The kinds whose names mean something within one file only."""

BODY_KINDS = frozenset((NameKind.JOINT, NameKind.POSTURE))
"""The kinds whose names belong to one robot's body."""


class NameUse(NamedTuple):
    """A use of a name: `name` says which thing of its kind, `scope` in which file's, `text` how it stands at `place`.

    A state's name is its path, however it is written.
    """

    kind: NameKind
    scope: str
    name: str
    text: str
    place: Place
    defines: bool = False

    @property
    def thing(self) -> tuple[NameKind, str, str]:
        """What all uses of one thing's name have in common."""
        return self.kind, self.scope, self.name


def covers(place: Place, line: int, column: int) -> bool:
    """Whether a cursor at that line and column, from 1, stands on the place or right behind it."""
    return (place.line, place.column) <= (line, column) <= (place.end_line, place.end_column)
