"""The MJCF of the robot and of the hall: whether it is XML, and whether what it names is there.

What MuJoCo thinks of it is told when it is simulated; it is not imported here.
"""

from collections.abc import Mapping
from pathlib import Path, PurePosixPath
from typing import NamedTuple
from xml.parsers import expat

from lumen.language.diagnostics import ERROR, Code, Place, nearest
from lumen.loading.draft import ProjectDraft
from lumen.loading.files import Unreadable

BROKEN_MODEL = Code("broken-model", "robot", ERROR, "a model is no MJCF, or lacks a file or a joint")


_FOLDERS = {"mesh": "meshdir", "skin": "meshdir", "texture": "texturedir", "hfield": "meshdir"}


class ModelElement(NamedTuple):
    """The beginning of an XML element, and where it stands."""

    name: str
    attributes: Mapping[str, str]
    line: int
    column: int


def check(draft: ProjectDraft) -> None:
    """Report models that are no MJCF, files that they need and that are not there, and joints that they lack."""
    settings = draft.settings
    if settings is None:
        return
    if settings.hall:
        _read(draft, settings.hall)
    robot = _read(draft, draft.body.mjcf) if draft.body else []
    if len(robot) > 1 and draft.body:
        _joints(draft, draft.body.mjcf, robot)


def _read(draft: ProjectDraft, name: str) -> list[ModelElement]:
    """The elements of a model, none where it can't be read; what is wrong with it is reported."""
    file = f"models/{name}"
    content = draft.files.get(file)
    if content is None or isinstance(content, Unreadable):
        return []
    elements: list[ModelElement] = []
    parser = expat.ParserCreate()

    def begin(name: str, attributes: Mapping[str, str]) -> None:
        elements.append(ModelElement(name, attributes, parser.CurrentLineNumber, parser.CurrentColumnNumber + 1))

    parser.StartElementHandler = begin
    try:
        parser.Parse(content, True)
    except ValueError as error:  # an encoding of several bytes
        _say(draft, file, 1, 1, 1, f"this is not XML: {error}", "save it as UTF-8")
        return []
    except expat.ExpatError as error:
        reason = expat.ErrorString(error.code)
        hint = "look for a tag or a quote that is not closed, here or above"
        _say(draft, file, error.lineno, error.offset + 1, 1, f"this is not XML: {reason}", hint)
        return []
    if elements[0].name != "mujoco":
        root = elements[0]
        message = f"this is not MJCF: it begins with `<{root.name}>`"
        _say(draft, file, root.line, root.column, len(root.name) + 1, message, "MJCF begins with `<mujoco>`")
        return []
    _assets(draft, file, elements)
    return elements


def _assets(draft: ProjectDraft, file: str, elements: list[ModelElement]) -> None:
    """Files that a model names; where the project lies in no folder, nobody knows whether they are there."""
    folders: dict[str, str] = {}
    for element in elements:
        if element.name == "compiler":
            folders |= {
                k: element.attributes.get(k) or element.attributes.get("assetdir", "") for k in _FOLDERS.values()
            }
    if draft.root is None or not (models := draft.root / "models").is_dir():
        return
    for element in elements:
        name = element.attributes.get("file")
        if name and (element.name in _FOLDERS or element.name == "include"):
            folder = folders.get(_FOLDERS.get(element.name, ""), "")
            if not _there(models / folder / name):
                there = [p.name for p in (models / folder).glob("*")] if (models / folder).is_dir() else []
                near = nearest(PurePosixPath(name).name, there)
                hint = f"did you mean `{near}`?" if near else "put it there, or delete what names it"
                path = PurePosixPath("models", folder, name)
                _say(draft, file, element.line, element.column, len(element.name) + 1, f"there is no file {path}", hint)


def _there(path: Path) -> bool:
    try:
        return path.is_file()
    except (OSError, ValueError):
        return False


def _joints(draft: ProjectDraft, name: str, elements: list[ModelElement]) -> None:
    """Joints that the description of the body has, and its model has not."""
    assert draft.body is not None
    assert draft.settings is not None
    if any(e.name in ("include", "attach", "replicate") for e in elements):
        return
    joints = {e.attributes.get("name", "") for e in elements if e.name == "joint"}
    report = draft.report("models", draft.settings.model)
    for joint in draft.body.joints:
        if joint not in joints:
            near = nearest(joint, joints)
            hint = f"did you mean `{near}`?" if near else f"give models/{name} a joint of that name"
            message = f"models/{name} has no joint `{joint}`"
            report(BROKEN_MODEL, ("joints", joint), message, hint=hint, key=True, cause=f"joints of {name}")


def _say(draft: ProjectDraft, file: str, line: int, column: int, length: int, message: str, hint: str) -> None:
    place = Place(file, line, column, line, column + length)
    draft.loose.append(BROKEN_MODEL.at(place, message, hint))
