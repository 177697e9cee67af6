"""Find files in the folder of another kind of file, and files that are not read because their names are mistyped."""

import os
import re
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path, PurePosixPath
from typing import Any, NamedTuple

from lumen.language.diagnostics import ERROR, Code
from lumen.project.document_report import DocumentReport
from lumen.project.files import belongs
from lumen.project.project_folders import ALL_FOLDERS, KINDS, endings_in

_ENDING = re.compile(r"(?P<stem>.+?)\s*\.(?:(?P<yaml>ya?ml)|(?P<other>md|json|xml))\s*(?:\.te?xt)?\s*", re.IGNORECASE)


class Misnamed(NamedTuple):
    """The path of a file or folder as it is and as it should be, from the project's root; a folder's ends with `/`."""

    there: str
    meant: str


def misnamed_in(root: Path, folder: str, listed: Sequence[str] | None = None) -> Iterator[Misnamed]:
    """Yield files of a project folder with a mistyped ending, such as `.yml`, and folders with capital letters.

    `listed` are the names in the folder, if the caller has listed them.
    """
    endings, listed = endings_in(folder), listed_in(root, folder) if listed is None else listed
    for name in listed:
        if endings and name.endswith(endings) and not name.startswith("."):
            continue  # read, as nearly all files are
        path = f"{folder}/{name}" if folder else name
        lowered = path.lower()
        if lowered != path and lowered in ALL_FOLDERS and not (root / lowered).exists():
            yield Misnamed(f"{path}/", f"{lowered}/")
        elif (found := _ENDING.fullmatch(name)) and not belongs(path) and (root / path).is_file():
            ending = f".{found['other'] or 'yaml'}".lower()
            meant = found["stem"] + ending
            if ending in endings and meant not in listed and not name.startswith("."):
                yield Misnamed(path, f"{folder}/{meant}")


def misnamed_for(root: Path, folder: str, name: str) -> Misnamed | None:
    """Return the misnamed file, or folder around it, that was probably meant to be `FOLDER/NAME`; else None."""
    above = ["", *map(str, reversed(PurePosixPath(folder).parents[:-1])), folder]
    found = (each for one in above for each in misnamed_in(root, one))
    fits = (
        each
        for each in found
        if each.meant.rstrip("/") in above or each.meant.partition(".")[0].lower() == f"{folder}/{name}".lower()
    )
    return next(fits, None)


def listed_in(root: Path, folder: str) -> list[str]:
    """Return the names in a folder, sorted; none if it can't be listed or lies outside the project."""
    try:
        listed = sorted(os.listdir(f"{root}/{folder}"))  # a path would take most of the time of this
        return listed if _is_inside(root, folder) else []
    except (OSError, RuntimeError):  # RuntimeError: links in a circle
        return []


def _is_inside(root: Path, folder: str) -> bool:
    """Return True if a folder lies in the project after links are resolved."""
    parts, path = folder.split("/"), str(root)
    if not folder or not any(os.path.islink(path := f"{path}/{part}") for part in parts):
        return True
    return (root / folder).resolve().is_relative_to(root.resolve())


MISPLACED_FILE = Code("misplaced-file", "text", ERROR, "a file is in the folder of another kind of file")


class _Kind(NamedTuple):
    """A kind of file, and the keys that identify it."""

    name: str
    """The name of the kind."""
    marks: frozenset[str]
    """Keys that identify a file if it has all of them."""
    alone: str = ""
    """A key that identifies a file by itself; empty if no single key does."""
    only: frozenset[str] = frozenset()
    """Keys that identify a file if it has no others, for a kind that has no keys of its own."""

    @property
    def keys(self) -> frozenset[str]:
        return self.only or self.marks | {self.alone}

    def owns(self, data: Mapping[str, Any]) -> bool:
        """Return True if data has at least one key of this kind; for a kind with `only`, if it has no other keys."""
        return data.keys() <= self.only if self.only else not self.keys.isdisjoint(data)

    def is_meant(self, data: Mapping[str, Any]) -> bool:
        """Return True if data from another folder is of this kind."""
        if self.only:
            return self.owns(data) and bool(data)
        return (bool(self.marks) and self.marks <= data.keys()) or self.alone in data


_KINDS: Mapping[str, _Kind] = {
    "lumen": _Kind("an exhibition", frozenset(("robot", "languages"))),
    "behavior": _Kind("a behaviour", frozenset(("states",))),
    "words": _Kind("a words file", frozenset(), only=frozenset(("description", "phrases", "answers", "lists"))),
    "sayings": _Kind("a file of sayings", frozenset()),
    "knowledge": _Kind("a passage of knowledge", frozenset(("questions", "answer"))),
    "questions": _Kind(
        "a file of test questions for knowledge",
        frozenset(),
        only=frozenset(("asked", "unanswered")),
    ),
    "story": _Kind("a story", frozenset(("steps",))),
    "function": _Kind("a function", frozenset(("expression",))),
    "controller": _Kind("a controller", frozenset(("inputs", "outputs"))),
    "motion": _Kind("a motion", frozenset(("keyframes",))),
    "life": _Kind("a style of life", frozenset(("sways",)), "blinks"),
    "gestures": _Kind("a library of gestures", frozenset(("gestures",))),
    "body": _Kind("a robot's body", frozenset(("joints", "camera")), "like"),
    "skill": _Kind("a skill", frozenset(("performed-by",))),
    "fleet": _Kind("a fleet", frozenset(("houses",))),
    "message": _Kind("a message schema", frozenset(("$schema", "properties"))),
}


def _home(kind: str) -> str:
    """Return the folder for a file of a kind, in words."""
    folder = next((path for path, other in KINDS.items() if other == kind), "")
    return f"{folder}/" if folder else f"the project's folder, as {kind}.yaml"


def misplaced(data: Any, kind: str, report: DocumentReport) -> bool:
    """Return True if data belongs in another kind of file and has no key of this kind; report such data."""
    own = _KINDS.get(kind)  # kinds of packages are not in it
    if own is None or not isinstance(data, Mapping) or own.owns(data):
        return False
    meant = next((name for name, other in _KINDS.items() if other is not own and other.is_meant(data)), None)
    if meant is None:
        return False
    other, file = _KINDS[meant], PurePosixPath(report.document.file)
    where = next(key for key in data if key in other.keys)
    message = f"this is {other.name}, but {own.name} belongs here"
    hint = f"move it to {_home(meant)}"
    report(MISPLACED_FILE, (where,), message, hint=hint, key=True, cause=f"{meant} {file.stem}")
    return True
