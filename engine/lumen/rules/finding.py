"""How a rule says what it found."""

from collections.abc import Iterable, Mapping
from typing import Any

from lumen.language.diagnostics import NodePath, did_you_mean
from lumen.loading.document_report import DocumentReport
from lumen.loading.draft import ProjectDraft
from lumen.rules.codes import CODES


def find(
    report: DocumentReport,
    code: str,
    path: NodePath,
    message: str,
    hint: str = "",
    *,
    key: bool = False,
    related: Iterable[tuple[NodePath, str]] = (),
    cause: str = "",
    root: str = "",
) -> None:
    """Report a finding of that code, as bad as `CODES` says."""
    severity = CODES[code].severity
    report(code, path, message, hint=hint, key=key, severity=severity, related=related, cause=cause, root=root)


def first(report: DocumentReport, *paths: NodePath) -> NodePath:
    """The first of these paths that stands in the document: a value may be written short or at length."""
    return next((path for path in paths if path in report.document.spans), paths[-1])


def value_at(report: DocumentReport, path: NodePath) -> Any:
    """The plain data at that path, None where there is nothing."""
    node = report.document.data
    for step in path:
        try:
            node = node[step]
        except (KeyError, IndexError, TypeError):
            return None
    return node


_FOLDERS: Mapping[str, tuple[str, str]] = {
    "behavior": ("behaviors", "behaviour"),
    "story": ("behaviors/stories", "story"),
    "controller": ("fuzzy", "controller"),
    "motion": ("motions", "motion"),
    "model": ("models", "robot"),
    "message": ("schemas/messages", "message schema"),
}


class References:
    """Looks names of files up; a folder in which nothing is, is reported once."""

    def __init__(self, draft: ProjectDraft) -> None:
        self._names = draft.names
        self._missing = draft.missing

    def look_up(self, report: DocumentReport, path: NodePath, kind: str, name: str, *, key: bool = False) -> bool:
        """Whether there is a file of that kind and name; reported at `path` where there is none."""
        folder, what = _FOLDERS[kind]
        names = self._names.get(folder, frozenset())
        if name in names:
            return True
        if names:
            hint = did_you_mean(name.rpartition("/")[2].removesuffix(".yaml"), names, f"{folder}/ has")
            cause = f"{kind} {name}"
            find(report, f"unknown-{kind}", path, f"there is no {what} `{name}`", hint, key=key, cause=cause)
        elif folder not in self._missing:
            self._missing.add(folder)
            hint = f"make the folder {folder}/ and put the file into it"
            message = f"there is no {what} `{name}`: {folder}/ is missing or empty"
            find(report, "missing-folder", path, message, hint, key=key)
        return False
