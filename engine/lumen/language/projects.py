"""A whole project as one immutable bundle."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import TypeVar

from lumen.feature import VerbRow
from lumen.language.controllers import ControllerDefinition
from lumen.language.diagnostics import NodePath, Place, Places
from lumen.language.functions import FunctionDefinition
from lumen.language.gestures import GestureLibrary
from lumen.language.house import RobotSpec
from lumen.language.knowledge import Passage, QuestionSet
from lumen.language.life import LifeStyle
from lumen.language.machines import MachineDefinition
from lumen.language.modules import EYES, ModuleSettings
from lumen.language.motions import MotionDefinition
from lumen.language.robots import Body
from lumen.language.routes import Route
from lumen.language.routing_keys import default_key
from lumen.language.sayings import SayingSet
from lumen.language.sections import Sections, section_of
from lumen.language.stories import Story

DEFAULT_PATIENCE = 60.0
"""The default time that saved files wait for running commands [s]."""

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Stage:
    """The area in which the robot may walk: a rectangle in the frame of the robot's start [m]."""

    x: tuple[float, float]
    y: tuple[float, float]


@dataclass(frozen=True)
class Project:
    """The content of a project's YAML."""

    root: str
    """The project's folder."""
    name: str
    robot: str
    """The robot's name in routing keys."""
    body: Body
    hall: str
    behavior: str
    """The name of the behaviour that runs, one of `behaviors`."""
    behaviors: Mapping[str, MachineDefinition]
    knowledge: Mapping[str, Passage] = field(default_factory=dict)
    questions: Mapping[str, QuestionSet] = field(default_factory=dict)
    """The questions with which `knowledge` is tested."""
    controllers: Mapping[str, ControllerDefinition] = field(default_factory=dict)
    motions: Mapping[str, MotionDefinition] = field(default_factory=dict)
    life: Mapping[str, LifeStyle] = field(default_factory=dict)
    gestures: Mapping[str, GestureLibrary] = field(default_factory=dict)
    routes: Mapping[str, Route] = field(default_factory=dict)
    stories: Mapping[str, Story] = field(default_factory=dict)
    sayings: Mapping[str, SayingSet] = field(default_factory=dict)
    """The sentences with which `hears` is tested."""
    functions: Mapping[str, FunctionDefinition] = field(default_factory=dict)
    messages: Mapping[str, Mapping[str, object]] = field(default_factory=dict)
    """The JSON Schema of each message, by name."""
    languages: tuple[str, ...] = ("en",)
    """The codes of the languages, the default language first."""
    timezone: str = ""
    """The time zone; empty for the machine's own."""
    story: str = ""
    stage: Stage | None = None
    bus: str = "memory://"
    patience: float = DEFAULT_PATIENCE
    """The time that saved files wait for running commands [s]."""
    modules: Mapping[str, ModuleSettings] = field(default_factory=dict)
    aliases: bool | None = None
    """True if routes have their aliases, False if not; None if they have them until another robot is on the bus."""
    hash: str = ""
    """The hash of all files' contents."""
    robots: Mapping[str, RobotSpec] = field(default_factory=dict)
    """All robots of the house; each has a project of its own, built from the same files."""
    told_apart: bool = False
    """True if lumen.yaml has `robots:`."""
    house: str = ""
    """The name of the house that the robots share."""
    sections: Sections = field(default_factory=dict)
    """The settings of features by the keys of their sections; `section` returns those of one section."""
    verbs: Mapping[str, VerbRow] = field(default_factory=dict)
    """The verbs that files of the project declare."""
    documents: Mapping[str, Places] = field(default_factory=dict, repr=False, compare=False)
    """The documents, which have the places of nodes, by file."""

    @property
    def machine(self) -> MachineDefinition:
        """The behaviour that runs."""
        return self.behaviors[self.behavior]

    @property
    def one_of_several(self) -> str:
        """The robot's name if it must be distinguished from others of the house, even on the disk; empty otherwise."""
        return self.robot if self.told_apart else ""

    @property
    def served(self) -> tuple[str, ...]:
        """The names of this robot and of the others that its module `eyes` also serves (by the option `robots`)."""
        others = self.modules[EYES].options.get("robots", ()) if EYES in self.modules else ()
        return tuple(dict.fromkeys((self.robot, *others)))

    def section(self, kind: type[T]) -> T:
        """Return the settings of this type, its defaults if lumen.yaml lacks the section."""
        return section_of(self.sections, kind)

    def with_section(self, key: str, settings: object) -> "Project":
        """Return the project with other settings in the section of that key."""
        return replace(self, sections={**self.sections, key: settings})

    def at(self, root: str) -> "Project":
        """Return the project with another folder as its root, which the programs of its verbs are started from."""
        verbs = {name: row._replace(root=root) for name, row in self.verbs.items()}
        return replace(self, root=root, verbs=verbs)

    def key_of(self, route: str) -> str:
        """Return this robot's routing key of a route of the project or of Lumen.

        Raises KeyError for an unknown route.
        """
        row = self.routes.get(route)
        return row.key_for(self.robot) if row else default_key(route, self.robot)

    def place(self, file: str, where: NodePath) -> Place:
        """Return the place of the node at a path, such as the `where` of a state; the file's first line if unknown."""
        document = self.documents.get(file)
        return document.place(where) if document else Place(file)
