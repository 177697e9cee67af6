"""What has become of a project's files so far."""

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
from lumen.project.project_folders import MAIN_FILE, WORDS_FOLDER
from lumen.project.settings import Settings


@dataclass
class ProjectDraft:
    """What could be built from a project's files, and what is wrong with them.

    `names` has for each folder the names of all files in it, whether they could be built or not; `reports` the report
    of each document by its file; `missing` the folders that were reported as missing; `unsound` the JSON Schemas in
    behaviours that were reported as broken: behaviour, `types` or `events`, name. `lent` are files that come with Lumen
    and stand where the project has none; `own_motions` those that lie in motions/MODEL/, for this robot alone.
    `functions` are those of the project that are sound, `known_functions` all of them as expressions see them.
    `words` may hold those that come with Lumen, which have no report: nobody can edit them.
    `verbs` are those that files of the project declare.
    `settings` is None where lumen.yaml could not be read at all. `root` is the project's folder, for what is needed of
    files that are not read; `looks` is told of each of them. `today` is the day on which somebody looks, None where
    that does not matter.
    """

    files: Mapping[str, bytes]
    lent: Mapping[str, bytes] = field(default_factory=dict)
    settings: Settings | None = None
    bodies: dict[str, Body] = field(default_factory=dict)
    behaviors: dict[str, MachineDefinition] = field(default_factory=dict)
    words: dict[str, Words] = field(default_factory=dict)
    knowledge: dict[str, Passage] = field(default_factory=dict)
    questions: dict[str, QuestionSet] = field(default_factory=dict)
    controllers: dict[str, ControllerDefinition] = field(default_factory=dict)
    motions: dict[str, MotionDefinition] = field(default_factory=dict)
    life: dict[str, LifeStyle] = field(default_factory=dict)
    gestures: dict[str, GestureLibrary] = field(default_factory=dict)
    verbs: OwnVerbs = NO_VERBS
    stories: dict[str, Story] = field(default_factory=dict)
    sayings: dict[str, SayingSet] = field(default_factory=dict)
    functions: dict[str, FunctionDefinition] = field(default_factory=dict)
    known_functions: KnownFunctions = field(default_factory=dict)
    messages: dict[str, Mapping[str, Any]] = field(default_factory=dict)
    names: dict[str, frozenset[str]] = field(default_factory=dict)
    reports: dict[str, DocumentReport] = field(default_factory=dict)
    loose: list[Diagnostic] = field(default_factory=list)
    missing: set[str] = field(default_factory=set)
    unsound: set[tuple[str, str, str]] = field(default_factory=set)
    root: Path | None = None
    own_motions: frozenset[str] = frozenset()
    beside: dict[str, Any] = field(default_factory=dict)
    """The settings in files beside lumen.yaml, by the file's name."""
    today: date | None = None
    looks: Looks = field(default_factory=Looks)

    @property
    def main(self) -> DocumentReport | None:
        """The report of lumen.yaml."""
        return self.reports.get(MAIN_FILE)

    @property
    def body(self) -> Body | None:
        """The body of the project's robot."""
        return self.bodies.get(self.settings.model) if self.settings else None

    @property
    def own_words(self) -> dict[str, Words]:
        """The words files of the project itself, without those that come with Lumen."""
        return {name: words for name, words in self.words.items() if f"{WORDS_FOLDER}/{name}.yaml" in self.reports}

    @property
    def diagnostics(self) -> list[Diagnostic]:
        """Everything found so far, each cause once, by file and line."""
        found = [d for r in self.reports.values() for d in r.diagnostics if not r.follows(d.code, d.message)]
        return gathered([*found, *self.loose])

    @property
    def whole_behaviors(self) -> bool:
        """Whether everything was built that the behaviours say."""
        names = self.names.get("behaviors", frozenset())
        return all(name in self.behaviors and self.report("behaviors", name).whole for name in names)

    def report(self, folder: str, name: str) -> DocumentReport:
        """The report of `FOLDER/NAME.yaml`; of a motion, of the file that holds it for this robot."""
        if folder == "motions" and name in self.own_motions and self.settings:
            folder = f"motions/{self.settings.model}"
        elif folder == KNOWLEDGE_FOLDER:
            return self.reports[self.knowledge[name].file]
        return self.reports[f"{folder}/{name}.yaml"]

    def say(self, code: Code, file: str, message: str, hint: str) -> None:
        """Report something of a file as a whole."""
        self.loose.append(code.at(Place(file), message, hint))


def body_of(found: ProjectDraft) -> Body:
    """The robot of a project whose other files may have errors; raises ProjectError where none can be built."""
    body = found.body or next(iter(found.bodies.values()), None)
    if body is None:
        raise ProjectError(found.diagnostics)
    return body
