"""The folders of a project and the kinds of file in them, for code that reads, watches, copies or completes them."""

from collections.abc import Mapping
from pathlib import PurePosixPath
from typing import NamedTuple

from lumen.feature import table
from lumen.language.folders import FUNCTIONS_FOLDER, KNOWLEDGE_FOLDER, QUESTIONS_FOLDER, SAYINGS_FOLDER

MAIN_FILE, MAIN_KIND = "lumen.yaml", "lumen"
FLEET_FILE = "fleet.yaml"
"""The file with the houses of a fleet and the keys whose orders a robot accepts. Lint checks it; no bundle has it."""

BEHAVIORS, STORIES, WORDS_FOLDER = "behaviors", "behaviors/stories", "behaviors/words"
CONTROLLERS = "fuzzy"
MOTIONS, LIFE_FOLDER, GESTURES_FOLDER = "motions", "motions/life", "motions/gestures"
MODELS, PASSAGES = "models", "models/passages"
SKILLS = "skills"
MESSAGES = "schemas/messages"


class ProjectFolder(NamedTuple):
    """A folder of a project, from its root; files in deeper folders are not read."""

    path: str
    kind: str
    """The kind of the YAML or JSON files in the folder; `schemas/KIND.schema.json` describes them."""
    endings: tuple[str, ...] = (".yaml", ".yml")
    """The endings of files that belong to the project; lint reports those in .yml, which nothing reads."""


FOLDERS = (
    ProjectFolder(BEHAVIORS, "behavior"),
    ProjectFolder(WORDS_FOLDER, "words"),
    ProjectFolder(SAYINGS_FOLDER, "sayings"),
    ProjectFolder(STORIES, "story"),
    ProjectFolder(KNOWLEDGE_FOLDER, "knowledge", (".yaml", ".yml", ".md")),
    ProjectFolder(QUESTIONS_FOLDER, "questions"),
    ProjectFolder(FUNCTIONS_FOLDER, "function"),
    ProjectFolder(CONTROLLERS, "controller"),
    ProjectFolder(MOTIONS, "motion"),
    ProjectFolder(LIFE_FOLDER, "life"),
    ProjectFolder(GESTURES_FOLDER, "gestures"),
    ProjectFolder(MODELS, "body", (".yaml", ".yml", ".xml")),
    ProjectFolder(PASSAGES, "motion"),
    ProjectFolder(SKILLS, "skill"),
    ProjectFolder(MESSAGES, "message", (".json",)),
)

KINDS: Mapping[str, str] = {folder.path: folder.kind for folder in FOLDERS}
"""The kind of file in each folder."""

PROJECT_FOLDERS = tuple(dict.fromkeys(folder.path.partition("/")[0] for folder in FOLDERS))
"""The folders next to lumen.yaml that belong to a project."""

ALL_FOLDERS = frozenset((*PROJECT_FOLDERS, *KINDS))

_ENDINGS: Mapping[str, tuple[str, ...]] = {folder.path: folder.endings for folder in FOLDERS}


def file_kinds() -> tuple[str, ...]:
    """Return all kinds of file. A kind has a `schemas/KIND.schema.json`, or a schema in the row of its feature."""
    return tuple(dict.fromkeys((MAIN_KIND, *KINDS.values(), *map(kind_of, table("files")))))


def is_root_file(path: str) -> bool:
    """Return True for the name of a YAML file in the project's root: lumen.yaml, or a file of a feature."""
    return path == MAIN_FILE or path in table("files")


def endings_in(folder: str) -> tuple[str, ...]:
    """Return the endings of files that belong to a project in a folder; none for other folders.

    A folder in motions/ counts as the folder of a robot's own motions.
    """
    return _ENDINGS.get(_shared(folder), ())


def is_robots_own(folder: str) -> bool:
    """Return True if a path, such as `motions/pepper`, is the folder of the motions of one robot."""
    above, _, name = folder.partition("/")
    return above == MOTIONS and bool(name) and folder not in KINDS and not {"/", "."} & set(name)


def life_of(model: str) -> str:
    """Return the folder with the styles of life of one robot, by the name of its model."""
    return f"{MOTIONS}/{model}/{PurePosixPath(LIFE_FOLDER).name}"


def gestures_of(model: str) -> str:
    """Return the folder with the libraries of gestures of one robot, by the name of its model."""
    return f"{MOTIONS}/{model}/{PurePosixPath(GESTURES_FOLDER).name}"


def kind_in(folder: str) -> str:
    """Return the kind of file in a folder of a project; empty for a folder of no kind."""
    return KINDS.get(_shared(folder), "")


def _shared(folder: str) -> str:
    """Return `motions` or `motions/life` for a robot's own folder of such files; any other folder is unchanged."""
    above = folder.rpartition("/")[0]
    if is_robots_own(above):
        model = PurePosixPath(above).name
        shared = {life_of(model): LIFE_FOLDER, gestures_of(model): GESTURES_FOLDER}
        return shared.get(folder, folder)
    return MOTIONS if is_robots_own(folder) else folder


def kind_of(file: str) -> str:
    """Return the kind of a YAML or JSON file by its path in a project; empty for any other file."""
    if is_root_file(file):
        return file.removesuffix(".yaml")
    path = PurePosixPath(file)
    return kind_in(str(path.parent)) if path.suffix in (".yaml", ".json") else ""
