"""The state of a project while its files are built."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import date
from pathlib import Path
from typing import Any

from lumen.errors import ProjectError
from lumen.expressions.own_functions import KnownFunctions
from lumen.language.controllers import ControllerDefinition
from lumen.language.diagnostics import Code, Diagnostic, Place, gathered
from lumen.language.folders import KNOWLEDGE_FOLDER
from lumen.language.functions import FunctionDefinition
from lumen.language.gestures import GestureLibrary
from lumen.language.knowledge import Passage, QuestionSet
from lumen.language.life import LifeStyle
from lumen.language.machines import MachineDefinition
from lumen.language.motions import MotionDefinition
from lumen.language.robots import Body
from lumen.language.sayings import SayingSet
from lumen.language.stories import Story
from lumen.language.words import Words
from lumen.project.added_verbs import NO_VERBS, OwnVerbs
from lumen.project.document_report import DocumentReport
from lumen.project.looks import Looks
from lumen.project.project_folders import GESTURES_FOLDER, LIFE_FOLDER, MAIN_FILE, WORDS_FOLDER, gestures_of, life_of
from lumen.project.settings import Settings


@dataclass
class ProjectDraft:
    """All that could be built from a project's files, and the findings about them."""

    files: Mapping[str, bytes]
    lent: Mapping[str, bytes] = field(default_factory=dict)
    """Files that come with Lumen, used because the project has no file of that name."""
    settings: Settings | None = None
    """The content of lumen.yaml; None if it can't be read at all."""
    bodies: dict[str, Body] = field(default_factory=dict)
    behaviors: dict[str, MachineDefinition] = field(default_factory=dict)
    words: dict[str, Words] = field(default_factory=dict)
    """The words files, which may include those that come with Lumen; these have no report."""
    knowledge: dict[str, Passage] = field(default_factory=dict)
    questions: dict[str, QuestionSet] = field(default_factory=dict)
    controllers: dict[str, ControllerDefinition] = field(default_factory=dict)
    motions: dict[str, MotionDefinition] = field(default_factory=dict)
    life: dict[str, LifeStyle] = field(default_factory=dict)
    gestures: dict[str, GestureLibrary] = field(default_factory=dict)
    verbs: OwnVerbs = NO_VERBS
    """The verbs that files of the project declare."""
    stories: dict[str, Story] = field(default_factory=dict)
    sayings: dict[str, SayingSet] = field(default_factory=dict)
    functions: dict[str, FunctionDefinition] = field(default_factory=dict)
    """The project's functions that have no faults."""
    known_functions: KnownFunctions = field(default_factory=dict)
    """All functions of the project, as expressions see them."""
    messages: dict[str, Mapping[str, Any]] = field(default_factory=dict)
    names: dict[str, frozenset[str]] = field(default_factory=dict)
    """For each folder, the names of all files in it, including those that could not be built."""
    reports: dict[str, DocumentReport] = field(default_factory=dict)
    """The report of each document, by the path of its file."""
    loose: list[Diagnostic] = field(default_factory=list)
    """Findings that belong to no document."""
    missing: set[str] = field(default_factory=set)
    """The folders that were reported as missing or unreadable."""
    unsound: set[tuple[str, str, str]] = field(default_factory=set)
    """The JSON Schemas in behaviours that were reported as invalid: behaviour, `types` or `events`, name."""
    root: Path | None = None
    """The project's folder, for checks of files that are not read here."""
    own_motions: frozenset[str] = frozenset()
    """The names of the motions in motions/MODEL/, which are for this robot alone."""
    own_life: frozenset[str] = frozenset()
    """The names of the styles of life in motions/MODEL/life/, which are for this robot alone."""
    own_gestures: frozenset[str] = frozenset()
    """The names of the libraries of gestures in motions/MODEL/gestures/, which are for this robot alone."""
    beside: dict[str, Any] = field(default_factory=dict)
    """The settings in files of the root folder other than lumen.yaml, by the file's name."""
    today: date | None = None
    """The day of the check; None if that does not matter."""
    looks: Looks = field(default_factory=Looks)
    """A record of the files outside the draft that a check looked at."""

    @property
    def main(self) -> DocumentReport | None:
        """The report of lumen.yaml; None if the file is absent."""
        return self.reports.get(MAIN_FILE)

    @property
    def body(self) -> Body | None:
        """The body of the project's robot; None if it could not be built."""
        return self.bodies.get(self.settings.model) if self.settings else None

    @property
    def own_words(self) -> dict[str, Words]:
        """The words files of the project itself, without those that come with Lumen."""
        return {name: words for name, words in self.words.items() if f"{WORDS_FOLDER}/{name}.yaml" in self.reports}

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """All findings so far, each cause once, sorted by file and line."""
        found = [d for r in self.reports.values() for d in r.diagnostics if not r.follows(d.code, d.message)]
        return gathered([*found, *self.loose])

    @property
    def whole_behaviors(self) -> bool:
        """True if everything in the behaviours was built."""
        names = self.names.get("behaviors", frozenset())
        return all(name in self.behaviors and self.report("behaviors", name).whole for name in names)

    def report(self, folder: str, name: str) -> DocumentReport:
        """Return the report of `FOLDER/NAME.yaml`; in knowledge/, the file can also be `NAME.md`.

        If this robot has its own file for a motion, a library of gestures or a style of life of that name, it is that
        file's report. Raises KeyError if there is no report, or if a passage of knowledge was not built.
        """
        if folder == "motions" and name in self.own_motions and self.settings:
            folder = f"motions/{self.settings.model}"
        elif folder == LIFE_FOLDER and name in self.own_life and self.settings:
            folder = life_of(self.settings.model)
        elif folder == GESTURES_FOLDER and name in self.own_gestures and self.settings:
            folder = gestures_of(self.settings.model)
        elif folder == KNOWLEDGE_FOLDER:
            return self.reports[self.knowledge[name].file]
        return self.reports[f"{folder}/{name}.yaml"]

    def say(self, code: Code, file: str, message: str, hint: str) -> None:
        """Report a finding about a file as a whole."""
        self.loose.append(code.at(Place(file), message, hint))


def body_of(found: ProjectDraft) -> Body:
    """Return the robot's body, even if other files have errors. Raises ProjectError if no body can be built."""
    body = found.body or next(iter(found.bodies.values()), None)
    if body is None:
        raise ProjectError(found.diagnostics)
    return body
