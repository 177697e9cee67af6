"""Build `Settings`, from which an exhibition is composed, from the plain data of lumen.yaml."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import isfinite
from typing import Any, TypeVar
from zoneinfo import available_timezones

from lumen.errors import UsageError
from lumen.expressions.wall_clock import zone
from lumen.language.diagnostics import ERROR, Code, Diagnostic, NodePath, did_you_mean, nearest
from lumen.language.house import RobotSpec
from lumen.language.modules import ModuleSettings
from lumen.language.projects import DEFAULT_PATIENCE, Stage
from lumen.language.routes import Route
from lumen.language.sections import Sections, section_of
from lumen.language.vocabulary import FIRST_VOCABULARY, VOCABULARY, VOCABULARY_KEY
from lumen.project.document_report import DocumentReport
from lumen.project.house import DEFAULT_ROBOT, build_house, build_robots, told_robots
from lumen.project.routes import build_routes, duration
from lumen.project.sections import is_section, read_sections
from lumen.project.units import LENGTHS

OTHER_VOCABULARY = Code("other-vocabulary", "text", ERROR, "the files were written for another vocabulary")
BAD_STAGE = Code("bad-stage", "robot", ERROR, "the robot does not start on the stage")
UNKNOWN_TIMEZONE = Code("unknown-timezone", "robot", ERROR, "`timezone` is not the name of a time zone")

NO_SUCH_ROBOT = Code("no-such-robot", "robot", ERROR, "lumen.yaml has no robot of that name")

T = TypeVar("T")


@dataclass(frozen=True)
class Settings:
    """The content of lumen.yaml; a text is empty if the file lacks it or if its value was refused."""

    vocabulary: int = FIRST_VOCABULARY
    name: str = ""
    robot: str = DEFAULT_ROBOT
    """The robot of this exhibition, one of `robots`; fields about one robot, such as `model`, are about it."""
    robots: Mapping[str, RobotSpec] = field(default_factory=dict)
    told_apart: bool = False
    """True if lumen.yaml has `robots:`, so that robots are distinguished by name."""
    house: str = ""
    model: str = ""
    hall: str = ""
    behavior: str = ""
    story: str = ""
    languages: tuple[str, ...] = ()
    timezone: str = ""
    routes: Mapping[str, Route] = field(default_factory=dict)
    removed_routes: frozenset[str] = frozenset()
    """The names of rows that are `null`."""
    stage: Stage | None = None
    bus: str = "memory://"
    patience: float = DEFAULT_PATIENCE
    modules: Mapping[str, ModuleSettings] = field(default_factory=dict)
    stand: str = ""
    aliases: bool | None = None
    sections: Sections = field(default_factory=dict)

    def section(self, kind: type[T]) -> T:
        """Return the settings of this type; its defaults if lumen.yaml lacks the section."""
        return section_of(self.sections, kind)


def build_settings(data: Any, report: DocumentReport, robot: str = "") -> Settings:
    """Return the settings in the data of lumen.yaml, which has the shape of lumen.schema.json but may lack any key.

    They are the settings of this `robot`, or of the first one if the name is empty. An unknown name is reported,
    and the first robot is used.
    """
    if not isinstance(data, Mapping):
        return Settings()
    modules = data.get("modules", {})
    robots, several = build_robots(data, report), told_robots(data)
    if robot and robot not in robots:
        hint = did_you_mean(robot, robots, "there are")
        report(NO_SUCH_ROBOT, ("robots",) if several else (), f"there is no robot `{robot}` any more", hint)
    own, rows = robots.get(robot) or next(iter(robots.values())), data.get("routes", {})
    return Settings(
        vocabulary=data.get(VOCABULARY_KEY, FIRST_VOCABULARY),
        name=data.get("name", ""),
        robot=own.name,
        robots=robots,
        told_apart=several,
        house=build_house(data),
        model=own.model,
        hall=data.get("hall", ""),
        behavior=own.behavior,
        story=own.story,
        languages=own.languages,
        timezone=_timezone(data, report),
        routes=build_routes({name: row for name, row in rows.items() if row is not None}, report, stand=own.stand),
        removed_routes=frozenset(name for name, row in rows.items() if row is None),
        stage=_stage(data, report),
        bus=data.get("bus", Settings.bus),
        patience=_patience(data, report),
        modules={name: _module(name, row, report) for name, row in modules.items()},
        stand=own.stand,
        aliases=False if several else data.get("aliases"),
        sections=read_sections(data, report),
    )


def said_at(settings: Settings, report: DocumentReport, key: str) -> NodePath:
    """Return the path of `model`, `behavior`, `languages` or `story` of this robot in lumen.yaml."""
    if settings.told_apart:
        own: NodePath = ("robots", settings.robot, key)
        if key == "model" or key in report.document.data["robots"][settings.robot]:
            return own
    return ("robot", key) if key == "model" else (key,)


def other_vocabulary(settings: Settings, report: DocumentReport) -> Diagnostic | None:
    """Return the finding about files that this Lumen would misread; None if it can read them."""
    place, said = report.document.place((VOCABULARY_KEY,)), settings.vocabulary
    if said > VOCABULARY:
        hint = f"install a newer Lumen; if the files use nothing newer, write `{VOCABULARY_KEY}: {VOCABULARY}`"
        return OTHER_VOCABULARY.at(
            place, f"this project is written for vocabulary {said}, but this Lumen supports {VOCABULARY}", hint
        )
    if said < VOCABULARY:
        message = (
            f"this project is written for vocabulary {said}, but this Lumen supports {VOCABULARY},"
            " in which some words have changed"
        )
        return OTHER_VOCABULARY.at(place, message, "run `lumen upgrade`: it rewrites the files and prints the changes")
    return None


def _module(name: str, row: Mapping[str, Any], report: DocumentReport) -> ModuleSettings:
    """Return the settings of a module; a module with a section of its own has its options there."""
    here = row.get("here", False)
    if "command" in row:
        health = duration(row, "health", report, ("modules", name)) if "health" in row else None
        return ModuleSettings(here, {}, tuple(map(str, row["command"])), health or 0.0)
    return ModuleSettings(here, {} if is_section(f"modules.{name}") else {k: v for k, v in row.items() if k != "here"})


def _patience(data: Mapping[str, Any], report: DocumentReport) -> float:
    length = duration(data.get("reload", {}), "patience", report, ("reload",))
    return DEFAULT_PATIENCE if length is None else length


def _timezone(data: Mapping[str, Any], report: DocumentReport) -> str:
    name: str = data.get("timezone", "")
    try:
        zone(name)
    except UsageError:
        near = nearest(name, sorted(available_timezones()))
        hint = (
            f"did you mean `{near}`?" if "/" in near or near == "UTC" else "write an IANA name such as `Europe/Berlin`"
        )
        report(UNKNOWN_TIMEZONE, ("timezone",), f"there is no time zone `{name}`", hint=hint)
        return ""
    return name


def _stage(data: Mapping[str, Any], report: DocumentReport) -> Stage | None:
    if "stage" not in data:
        return None
    unit = LENGTHS[data.get("units", {}).get("length", "m")]
    spans = []
    for axis in ("x", "y"):
        low, high = data["stage"][axis]
        if not (isfinite(low) and isfinite(high) and low <= 0.0 <= high and low < high):
            message = f"the robot starts at 0, which is not inside [{low:g}, {high:g}]"
            report(
                BAD_STAGE,
                ("stage", axis),
                message,
                hint="write a first number that is at most 0, and a second that is at least 0",
            )
            return None
        spans.append((low * unit, high * unit))
    return Stage(*spans)
