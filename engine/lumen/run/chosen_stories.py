"""The stories and sayings meant by a word on the command line: by name, pattern of names, or file."""

import os
from collections.abc import Iterable, Iterator, Mapping
from fnmatch import fnmatchcase
from pathlib import Path
from typing import TypeVar

from lumen.errors import UsageError
from lumen.language.diagnostics import did_you_mean
from lumen.language.folders import SAYINGS_FOLDER
from lumen.language.projects import Project
from lumen.language.sayings import SayingSet
from lumen.language.stories import Story
from lumen.project.files import composed
from lumen.project.project_folders import MAIN_FILE, STORIES

FOLDER = Path(STORIES)

T = TypeVar("T")


def project_of(words: Iterable[str]) -> str | None:
    """Return the project folder of the first word that is a path to a story file; None if there is none."""
    for word in words:
        file = Path(os.path.abspath(word))
        if _is_file(word) and len(file.parents) > 2 and (file.parents[2] / MAIN_FILE).is_file():
            return str(file.parents[2])
    return None


def stories_of(project: Project, word: str) -> Iterator[Story]:
    """Yield the stories of a project that a word means: `shy`, `shy.yaml`, a path to that file, or `safety_*`.

    Raises UsageError if the word means no story. A file outside the project is never one of its stories, even if the
    file has a story's name.
    """
    found = _named(project, word, FOLDER, project.stories)
    if not found:
        raise _nothing(project, word, project.stories, "behaviors/stories/ has")
    yield from found


def tests_of(project: Project, word: str) -> tuple[list[Story], list[SayingSet]]:
    """Return the stories and the files of sayings that a word means, by the rules of `stories_of`.

    Raises UsageError if it means none.
    """
    found = (
        _named(project, word, FOLDER, project.stories),
        _named(project, word, Path(SAYINGS_FOLDER), project.sayings),
    )
    if not any(found):
        known = {**project.stories, **project.sayings}
        raise _nothing(project, word, known, "there are" if project.sayings else "behaviors/stories/ has")
    return found


def _is_file(word: str) -> bool:
    return word.endswith((".yaml", ".yml")) or "/" in word or os.sep in word


def _named(project: Project, word: str, folder: Path, known: Mapping[str, T]) -> list[T]:
    """Return the entries of `known` that a word means.

    A path may be relative to the working directory, the project or `folder`.
    """
    if not _is_file(word):
        return [known[name] for name in sorted(known) if name == word or fnmatchcase(name, word)]
    whole = Path(os.path.abspath(project.root)) / folder
    for base in (Path(), Path(project.root), whole):
        file = Path(os.path.abspath(base / word))
        if file.parent == whole and file.suffix == ".yaml" and (stem := composed(file.stem)) in known:
            return [known[stem]]
    return []


def _nothing(project: Project, word: str, known: Iterable[str], what: str) -> UsageError:
    """Return the error for a word that means nothing in a project."""
    if Path(word).is_file():
        folder = Path(os.path.abspath(project.root)) / FOLDER
        return UsageError(f"{word} is not in {folder}: move it there, so that it is checked with the project")
    name = Path(word).stem if _is_file(word) else word
    hint = did_you_mean(name, known, what)
    return UsageError(f"no {'story' if _is_file(word) else 'project or story'} `{word}`: {hint}")
