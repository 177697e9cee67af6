"""Files in the project's folders that are not read because of their names or their folders' names."""

from dataclasses import replace

from lumen.project.building import MISSING_FILE, NOT_READ
from lumen.project.draft import ProjectDraft
from lumen.project.files import MISTAKEN_FOLDERS
from lumen.project.lending import shipped_models
from lumen.project.misplaced import misnamed_in
from lumen.project.packaged import misnamed_main_file
from lumen.project.project_folders import ALL_FOLDERS, MAIN_FILE, MODELS
from lumen.project.unread import unread_in


def check(draft: ProjectDraft) -> None:
    """Report files and folders whose names are slightly wrong, and files in folders that are not read."""
    if draft.root is None:
        return
    for folder in ("", *sorted((*ALL_FOLDERS, *MISTAKEN_FOLDERS))):
        draft.looks.at(f"{draft.root}/{folder}")
        for there, meant in misnamed_in(draft.root, folder):
            name = meant if meant.endswith("/") else meant.rpartition("/")[2]
            message = f"Lumen does not read this: its name is not `{name}`"
            draft.say(NOT_READ, there.rstrip("/"), message, f"rename it to {name}")
    for file, message, hint in unread_in(draft.root, {*draft.names.get(MODELS, ()), *shipped_models()}, draft.looks.at):
        draft.say(NOT_READ, file, message, hint)
    if MAIN_FILE not in draft.files and (there := misnamed_main_file(draft.root)):
        hint = f"rename {there} to {MAIN_FILE}"
        draft.loose[:] = [replace(d, hint=hint) if d.code == MISSING_FILE else d for d in draft.loose]
