"""Looks up file names for the rules, and paths in a document."""

from collections.abc import Mapping

from lumen.language.diagnostics import ERROR, Code, NodePath, did_you_mean, nearest
from lumen.project.bodies import UNKNOWN_MODEL
from lumen.project.document_report import DocumentReport
from lumen.project.draft import ProjectDraft
from lumen.project.keyframes import UNKNOWN_MOTION
from lumen.project.lending import shipped_names
from lumen.project.linking import UNKNOWN_BEHAVIOR
from lumen.project.misplaced import misnamed_for

MISSING_FOLDER = Code("missing-folder", "text", ERROR, "a name refers to a folder that is empty or missing")
UNKNOWN_CONTROLLER = Code(
    "unknown-controller", "references", ERROR, "a name refers to a controller that is not in fuzzy/"
)
UNKNOWN_LIFE = Code(
    "unknown-life", "references", ERROR, "a name refers to a style of life that is not in motions/life/"
)
UNKNOWN_MESSAGE = Code(
    "unknown-message", "references", ERROR, "a name refers to a message schema that is not in schemas/messages/"
)
UNKNOWN_STORY = Code("unknown-story", "references", ERROR, "a name refers to a story that is not in behaviors/stories/")


def first(report: DocumentReport, *paths: NodePath) -> NodePath:
    """Return the first of these paths that is in the document, else the last, because a value can have a short form."""
    return next((path for path in paths if path in report.document.spans), paths[-1])


_FOLDERS: Mapping[str, tuple[str, str, Code]] = {
    "behavior": ("behaviors", "behaviour", UNKNOWN_BEHAVIOR),
    "story": ("behaviors/stories", "story", UNKNOWN_STORY),
    "controller": ("fuzzy", "controller", UNKNOWN_CONTROLLER),
    "life": ("motions/life", "style of life", UNKNOWN_LIFE),
    "motion": ("motions", "motion", UNKNOWN_MOTION),
    "model": ("models", "robot", UNKNOWN_MODEL),
    "message": ("schemas/messages", "message schema", UNKNOWN_MESSAGE),
}
"""For each kind of file: its folder, its name in messages, and the code for an unknown name."""


class References:
    """Looks up names of files; an empty folder is reported only once."""

    def __init__(self, draft: ProjectDraft) -> None:
        self._root, self._names = draft.root, draft.names
        self._missing = draft.missing

    def look_up(self, report: DocumentReport, path: NodePath, kind: str, name: str, *, key: bool = False) -> bool:
        """Return whether there is a file of that kind and name; if not, report the name at `path`."""
        folder, what, code = _FOLDERS[kind]
        names = self._names.get(folder, frozenset())
        if name in names:
            return True
        word = name.rpartition("/")[2].removesuffix(".yaml")
        lent = "" if nearest(word, names) else nearest(word, shipped_names(folder))
        mean_lent = f"did you mean `{lent}`, which comes with Lumen? " if lent else ""
        there = misnamed_for(self._root, folder, name) if self._root else None
        if there:
            hint, cause = f"rename {there.there} to {there.meant}", f"{kind} {name}"
            report(code, path, f"there is no {what} `{name}`", hint, key=key, cause=cause)
        elif names:
            hint = mean_lent + did_you_mean(word, names, f"{folder}/ has")
            cause = f"{kind} {name}"
            report(code, path, f"there is no {what} `{name}`", hint, key=key, cause=cause)
        elif folder not in self._missing:
            self._missing.add(folder)
            hint = f"create the folder {folder}/ and put the file into it"
            hint = f"{mean_lent}Otherwise {hint}" if lent else hint
            message = f"there is no {what} `{name}`: {folder}/ is missing or empty"
            report(MISSING_FOLDER, path, message, hint, key=key)
        return False
