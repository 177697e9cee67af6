"""Checks that the skills' programs are in the project, and that Python code fits its manifest."""

import os
from pathlib import PurePosixPath

from lumen.features.skills.manifest import Skill
from lumen.features.skills.python_file import code_faults
from lumen.language.diagnostics import WARNING, Code, Diagnostic, Place, did_you_mean
from lumen.project.draft import ProjectDraft
from lumen.project.keyframes import KEYFRAME_KEYS
from lumen.upkeep.regular_files import MEGABYTE

SKILL_CODE = Code("skill-code", "skills", WARNING, "the Python code of a skill does not fit its manifest")
SKILL_PROGRAM = Code("skill-program", "skills", WARNING, "a file of a skill's program is missing, or can't be read")
SKILL_KEYFRAME = Code("skill-keyframe", "skills", WARNING, "no motion can begin a skill, because of its name")

MAX_CODE_BYTES = 4 * MEGABYTE


def check(draft: ProjectDraft) -> None:
    """Report names that motions can't use, missing programs, and Python code that does not fit its manifest.

    No code is run.
    """
    if draft.root is None:
        return
    for name, row in draft.verbs.rows.items():
        if name in KEYFRAME_KEYS and row.details:
            message = f"`{name}` is a key of keyframes in motions, so no motion can begin this skill"
            draft.report("skills", name)(SKILL_KEYFRAME, (), message, "give the file another name")
        match row.details:
            case Skill("python", (file,)):
                _python(draft, name, file)
            case Skill("command", (_, *words)):
                for i, word in enumerate(words, 1):
                    if word.startswith("skills/") and not _is_there(draft, word):
                        _missing(draft, name, word, ("performed-by", "command", i))


def _python(draft: ProjectDraft, name: str, file: str) -> None:
    assert draft.root is not None
    path = draft.root / file
    real = draft.looks.at(path)
    if not os.path.isfile(real):
        _missing(draft, name, file, ("performed-by", "python"))
        return
    try:
        with open(real, "rb") as opened:
            content = opened.read(MAX_CODE_BYTES)
    except OSError as error:
        message = f"`{file}` can't be read: {(error.strerror or 'the system refuses').lower()}"
        draft.report("skills", name)(SKILL_PROGRAM, ("performed-by", "python"), message, "make it a readable file")
        return
    for fault in code_faults(content, file, name, draft.verbs.rows[name].arguments):
        place = Place(file, fault.line, fault.column, fault.line, fault.end_column)
        draft.loose.append(Diagnostic(SKILL_CODE, fault.message, place, fault.hint, SKILL_CODE.severity))


def _is_there(draft: ProjectDraft, file: str) -> bool:
    assert draft.root is not None
    return os.path.isfile(draft.looks.at(draft.root / file))


def _missing(draft: ProjectDraft, name: str, file: str, where: tuple[str | int, ...]) -> None:
    assert draft.root is not None
    path = PurePosixPath(file)
    there = [f"{path.parent}/{each.name}" for each in sorted((draft.root / file).parent.glob(f"*{path.suffix}"))]
    hint = did_you_mean(file, there, "there are") if there else "write this file"
    draft.report("skills", name)(SKILL_PROGRAM, where, f"there is no file {file}", hint)
