"""Files in the project's folders that are not read because their names are slightly wrong."""

from dataclasses import replace

from lumen.project.building import MISSING_FILE, NOT_READ
from lumen.project.draft import ProjectDraft
from lumen.project.files import MISTAKEN_FOLDERS
from lumen.project.misplaced import misnamed_in
from lumen.project.packaged import misnamed_main_file
from lumen.project.project_folders import ALL_FOLDERS, MAIN_FILE


def check(draft: ProjectDraft) -> None:
    """Report files whose ending has capital letters or is followed by another one, and folders with capital letters."""
    if draft.root is None:
        return
    for folder in ("", *sorted((*ALL_FOLDERS, *MISTAKEN_FOLDERS))):
        draft.looks.at(draft.root / folder)
        for there, meant in misnamed_in(draft.root, folder):
            name = meant if meant.endswith("/") else meant.rpartition("/")[2]
            message = f"Lumen does not read this: its name is not `{name}`"
            draft.say(NOT_READ, there.rstrip("/"), message, f"rename it to {name}")
    if MAIN_FILE not in draft.files and (there := misnamed_main_file(draft.root)):
        hint = f"rename {there} to {MAIN_FILE}"
        draft.loose[:] = [replace(d, hint=hint) if d.code == MISSING_FILE else d for d in draft.loose]
