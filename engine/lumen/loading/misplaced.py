"""Files of one kind that stand in the folder of another: told once, not key by key."""

from collections.abc import Mapping
from pathlib import PurePosixPath
from typing import Any, NamedTuple

from lumen.language.diagnostics import ERROR, Code
from lumen.loading.document_report import DocumentReport

MISPLACED_FILE = Code("misplaced-file", "text", ERROR, "a file stands in the folder of another kind")


class _Kind(NamedTuple):
    """What such a file is called, where it stands, and the keys by which one knows it, or else a single one."""

    name: str
    folder: str
    marks: frozenset[str]
    alone: str = ""


_KINDS: Mapping[str, _Kind] = {
    "lumen": _Kind("an exhibition", "the project's folder, as lumen.yaml", frozenset(("robot", "languages"))),
    "behavior": _Kind("a behaviour", "behaviors/", frozenset(("states",))),
    "story": _Kind("a story", "behaviors/stories/", frozenset(("steps",))),
    "controller": _Kind("a controller", "fuzzy/", frozenset(("inputs", "outputs"))),
    "motion": _Kind("a motion", "motions/", frozenset(("keyframes",))),
    "body": _Kind("a robot's body", "models/", frozenset(("joints", "camera")), "like"),
    "message": _Kind("a message schema", "schemas/messages/", frozenset(("$schema", "properties"))),
}


def misplaced(data: Any, kind: str, report: DocumentReport) -> bool:
    """Whether the data is that of another kind of file, and has nothing that makes one of this kind; it is reported."""
    own = _KINDS[kind]
    if not isinstance(data, Mapping) or {*own.marks, own.alone} & data.keys():
        return False
    meant = next((n for n, other in _KINDS.items() if other.marks <= data.keys() or other.alone in data), None)
    if meant is None:
        return False
    other, file = _KINDS[meant], PurePosixPath(report.document.file)
    where = next(key for key in data if key in {*other.marks, other.alone})
    message = f"this is {other.name}, where {own.name} should stand"
    hint = f"its place is {other.folder}"
    report(MISPLACED_FILE, (where,), message, hint=hint, key=True, cause=f"{meant} {file.stem}")
    return True
