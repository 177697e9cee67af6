"""The MJCF of the robot and of the hall: whether it is XML, and whether what it names is there.

What MuJoCo thinks of it is told when it is simulated; it is not imported here.
"""

import os
from dataclasses import dataclass, field
from pathlib import PurePosixPath

from lumen.language.diagnostics import ERROR, Code, Place, nearest
from lumen.loading.draft import ProjectDraft
from lumen.loading.files import MAX_FILE_BYTES, Unreadable
from lumen.loading.memoization import memoize
from lumen.loading.regular_files import read_regular
from lumen.rules.mjcf_elements import ModelElement, ModelFault, mjcf_elements
from lumen.rules.model_files import missing, outside

BROKEN_MODEL = Code("broken-model", "robot", ERROR, "a model is no MJCF, or lacks a file or a joint")
FOREIGN_FILE = Code("foreign-file", "robot", ERROR, "a model names a file that lies outside of models/")

_FOLDERS = {"mesh": "meshdir", "skin": "meshdir", "hfield": "meshdir", "flexcomp": "meshdir", "texture": "texturedir"}
_NAMES = ("file", "fileright", "fileleft", "fileup", "filedown", "filefront", "fileback")
"""Attributes that name a file."""


def check(draft: ProjectDraft) -> None:
    """Report models that are no MJCF, files that they need and that are not there, and joints that they lack."""
    settings = draft.settings
    if settings is None:
        return
    if settings.hall:
        _ModelReader(draft).read(settings.hall)
    robot = _ModelReader(draft).read(draft.body.mjcf) if draft.body else []
    if len(robot) > 1 and draft.body:
        _joints(draft, draft.body.mjcf, robot)


@dataclass
class _ModelReader:
    """Reads a model and what it includes, each file once, and reports what is wrong with them.

    Where the project lies in no folder, nobody knows whether what they name is there.
    """

    draft: ProjectDraft
    seen: set[str] = field(default_factory=set)
    around: list[str] = field(default_factory=list)

    def read(self, name: str) -> list[ModelElement]:
        """The elements of a model, none where it can't be read."""
        first, content = not self.seen, self.content(f"models/{name}")
        self.seen.add(name)
        if content is None:
            return []
        elements, fault = memoize(("mjcf", name), content, lambda: mjcf_elements(content))
        if not fault and elements[0].name not in ("mujoco", "" if first else "mujocoinclude"):
            root = elements[0]
            message = f"this is not MJCF: it begins with `<{root.name}>`"
            fault = ModelFault(root.line, root.column, len(root.name) + 1, message, "MJCF begins with `<mujoco>`")
        if fault:
            _say(self.draft, BROKEN_MODEL, name, *fault)
            return []
        if f"models/{name}" not in self.draft.lent:
            self.around.append(name)
            self.named(name, elements)
            self.around.pop()
        return elements

    def content(self, file: str) -> bytes | None:
        """What a file holds; one in a folder within models/, too."""
        content = self.draft.files.get(file, self.draft.lent.get(file))
        if content is None and self.draft.root:
            try:
                return read_regular(self.draft.root / file, MAX_FILE_BYTES)
            except OSError:
                return None
        return None if isinstance(content, Unreadable) else content

    def named(self, model: str, elements: list[ModelElement]) -> None:
        """Look for the files that a model names, and into those that it includes."""
        folders: dict[str, str] = {}
        for element in elements:
            if element.name == "compiler":
                folders |= {
                    k: element.attributes.get(k) or element.attributes.get("assetdir", "") for k in _FOLDERS.values()
                }
        for element in elements:
            folder = folders.get(_FOLDERS.get(element.name, ""), "")
            for name in filter(None, map(element.attributes.get, _NAMES)):
                if self.found(model, element, folder, name) and element.name == "include":
                    self.include(model, element, os.path.normpath(name).replace(os.sep, "/"))

    def include(self, model: str, element: ModelElement, inner: str) -> None:
        """Read what a model includes, where that was not done before."""
        if inner in self.around:
            place = model, element.line, element.column, len(element.name) + 1
            _say(self.draft, BROKEN_MODEL, *place, f"the model includes itself: {inner}", "delete this line")
        elif inner not in self.seen:
            self.read(inner)

    def found(self, model: str, element: ModelElement, folder: str, name: str) -> bool:
        """Whether a file that an element names lies in models/ and is there; reported where not."""
        place = model, element.line, element.column, len(element.name) + 1
        if outside(self.draft.root, folder, name):
            message = "this names a file outside of models/, and nothing that lies elsewhere is read"
            _say(self.draft, FOREIGN_FILE, *place, message, "put the file into models/, and name it from there")
            return False
        if hint := missing(self.draft.root, folder, name):
            path = PurePosixPath("models", folder, name)
            _say(self.draft, BROKEN_MODEL, *place, f"there is no file {path}", hint)
        return not hint


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


def _say(
    draft: ProjectDraft, code: Code, model: str, line: int, column: int, length: int, message: str, hint: str
) -> None:
    place = Place(f"models/{model}", line, column, line, column + length)
    draft.loose.append(code.at(place, message, hint))
