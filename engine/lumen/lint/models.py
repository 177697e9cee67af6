"""The MJCF of the robot and of the hall: whether it is valid XML, and whether the files and joints that it names exist.

MuJoCo's own errors are reported when the model is simulated; MuJoCo is not imported here.
"""

import os
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath

from lumen.language.diagnostics import ERROR, Code, NodePath, Place, nearest
from lumen.language.robots import Body
from lumen.language.roles import Roles
from lumen.lint.mjcf_elements import ModelElement, ModelFault, mjcf_elements
from lumen.project.draft import ProjectDraft
from lumen.project.files import MAX_FILE_BYTES, Unreadable
from lumen.project.memoization import memoize
from lumen.project.packaged_models import in_package
from lumen.upkeep.regular_files import read_regular

_MODELS = "models"


def outside(draft: ProjectDraft, folder: str, name: str) -> bool:
    """Return whether a name leads out of models/, or, if the project is in a folder, by a link out of the project."""
    path = os.path.normpath(os.path.join(_MODELS, folder, name))
    if "\\" in name or "\0" in name or not path.startswith(_MODELS + os.sep):
        return True
    if draft.root is None:
        return False
    real, project = draft.looks.at(f"{draft.root}/{path}"), draft.looks.at(draft.root)
    return not real.startswith(project.rstrip(os.sep) + os.sep)


def missing(draft: ProjectDraft, folder: str, name: str) -> str:
    """Return the hint for a file that is missing in models/; empty if the file is there, or if this is unknown."""
    if draft.root is None:
        return ""
    models = f"{draft.root}/{_MODELS}"
    beside = os.path.join(models, folder)
    file = os.path.join(beside, name)
    for path in (models, beside, file):
        draft.looks.at(path)
    if not os.path.isdir(models) or os.path.isfile(file):
        return ""
    near = nearest(PurePosixPath(name).name, [path.name for path in Path(beside).glob("*")])
    return f"did you mean `{near}`?" if near else "add the file, or delete the reference to it"


BROKEN_MODEL = Code("broken-model", "robot", ERROR, "a model is not MJCF, or lacks a file or a joint")
FOREIGN_FILE = Code("foreign-file", "robot", ERROR, "a model refers to a file outside models/")

_FOLDERS = {"mesh": "meshdir", "skin": "meshdir", "hfield": "meshdir", "flexcomp": "meshdir", "texture": "texturedir"}
_NAMES = ("file", "fileright", "fileleft", "fileup", "filedown", "filefront", "fileback")
"""The attributes that name a file."""


def check(draft: ProjectDraft) -> None:
    """Report invalid MJCF, missing files to which it refers, and joints of the body that the model lacks."""
    settings = draft.settings
    if settings is None:
        return
    if settings.hall:
        _ModelReader(draft).read(settings.hall)
    robot = _ModelReader(draft).read(draft.body.mjcf) if draft.body and draft.body.mjcf else []
    if len(robot) > 1 and draft.body:
        _elements(draft, draft.body, robot)


@dataclass
class _ModelReader:
    """Reads a model and the models that it includes, each once, and reports their faults.

    If the project is not in a folder, missing files are not reported, because it is unknown which files exist.
    """

    draft: ProjectDraft
    seen: set[str] = field(default_factory=set)
    """The models that have been read."""
    around: list[str] = field(default_factory=list)
    """The models that are being read, the outermost first."""

    def read(self, name: str) -> list[ModelElement]:
        """Return the elements of a model; empty if it can't be read."""
        first, content = not self.seen, self.content(f"models/{name}")
        self.seen.add(name)
        if content is None:
            return []
        elements, fault = memoize(("mjcf", name), content, lambda: mjcf_elements(content))
        if not fault and elements[0].name not in ("mujoco", "" if first else "mujocoinclude"):
            root = elements[0]
            message = f"this is not MJCF: it begins with `<{root.name}>`"
            fault = ModelFault(root.line, root.column, len(root.name) + 1, message, "begin the file with `<mujoco>`")
        if fault:
            _say(self.draft, BROKEN_MODEL, name, *fault)
            return []
        if f"models/{name}" not in self.draft.lent and not in_package(name):
            self.around.append(name)
            self.named(name, elements)
            self.around.pop()
        return elements

    def content(self, file: str) -> bytes | None:
        """Return the content of a file, in models/, one of its folders or a package; None if it can't be read."""
        if in_package(file):
            path = self.draft.looks.package_file(file.removeprefix("models/"))
            return read_regular(path, MAX_FILE_BYTES) if path else None
        content = self.draft.files.get(file, self.draft.lent.get(file))
        if content is None and self.draft.root:
            self.draft.looks.at(self.draft.root / file)
            try:
                return read_regular(self.draft.root / file, MAX_FILE_BYTES)
            except OSError:
                return None
        return None if isinstance(content, Unreadable) else content

    def named(self, model: str, elements: list[ModelElement]) -> None:
        """Report missing files that a model names, and read the models that it includes."""
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
        """Read an included model unless it has been read; report a model that includes itself."""
        if inner in self.around:
            place = model, element.line, element.column, len(element.name) + 1
            _say(self.draft, BROKEN_MODEL, *place, f"the model includes itself: {inner}", "delete this line")
        elif inner not in self.seen:
            self.read(inner)

    def found(self, model: str, element: ModelElement, folder: str, name: str) -> bool:
        """Return whether a file that an element names is in models/, True if that is unknown; report a missing one."""
        place = model, element.line, element.column, len(element.name) + 1
        if outside(self.draft, folder, name):
            message = "this refers to a file outside models/, which Lumen does not read"
            _say(self.draft, FOREIGN_FILE, *place, message, "move the file into models/, and correct its path here")
            return False
        if hint := missing(self.draft, folder, name):
            path = PurePosixPath("models", folder, name)
            _say(self.draft, BROKEN_MODEL, *place, f"there is no file {path}", hint)
        return not hint


def _elements(draft: ProjectDraft, body: Body, elements: list[ModelElement]) -> None:
    """Report joints, links, sites and other elements that the body's description names and the model lacks."""
    assert draft.settings is not None
    if any(e.name in ("include", "attach", "replicate") for e in elements):
        return
    there: dict[str, set[str]] = {}
    for element in elements:
        there.setdefault(element.name, set()).add(element.attributes.get("name", ""))
    report, name = draft.report("models", draft.settings.model), body.mjcf
    for kind, wanted, path, key in (
        *(("joint", j, ("joints", j), True) for j in body.joints),
        *_role_elements(body.roles),
    ):
        if wanted not in there.get(kind, ()):
            near, article = nearest(wanted, there.get(kind, ())), "an" if kind[0] in "aeiou" else "a"
            hint = f"did you mean `{near}`?" if near else f"add {article} {kind} of that name to models/{name}"
            message = f"models/{name} has no {kind} `{wanted}`"
            report(BROKEN_MODEL, path, message, hint=hint, key=key, cause=f"{kind}s of {name}")


def _role_elements(roles: Roles) -> Iterator[tuple[str, str, NodePath, bool]]:
    """Yield the elements of the model that the roles name, besides `joints`.

    Each comes with its kind, its name, its path, and False.
    """
    sensors = roles.sensors
    one: list[tuple[str, str, NodePath]] = [
        ("body", roles.torso, ("torso",)),
        ("camera", roles.eyes.camera, ("eyes", "camera")),
        ("body", roles.eyes.face, ("eyes", "face")),
        *(("site", site, ("soles", side)) for side, site in roles.soles.items()),
        ("joint", roles.base.left, ("base", "left")),
        ("joint", roles.base.right, ("base", "right")),
        ("gyro", sensors.gyro, ("sensors", "gyro")),
        ("accelerometer", sensors.accelerometer, ("sensors", "accelerometer")),
        *(("site", site, ("sensors", "sonar", side)) for side, site in sensors.sonar.items()),
        *(
            ("site", site, ("sensors", "force", side, i))
            for side, sites in sensors.force.items()
            for i, site in enumerate(sites)
        ),
        *(
            ("material", name, ("lights", group, i))
            for group, names in roles.lights.items()
            for i, name in enumerate(names)
        ),
    ]
    return ((kind, name, ("roles", *path), False) for kind, name, path in one if name)


def _listed(lists: Mapping[str, tuple[str, ...]]) -> Iterator[tuple[str, NodePath]]:
    """Yield each name of these lists, with its path in them."""
    return ((name, (key, i)) for key, names in lists.items() for i, name in enumerate(names))


def _say(
    draft: ProjectDraft, code: Code, model: str, line: int, column: int, length: int, message: str, hint: str
) -> None:
    place = Place(f"models/{model}", line, column, line, column + length)
    draft.loose.append(code.at(place, message, hint))
