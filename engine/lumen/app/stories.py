"""Which stories are meant: by name, by a pattern of names, or by file."""

import os
from collections.abc import Iterable, Iterator
from fnmatch import fnmatchcase
from pathlib import Path

from lumen.errors import UsageError
from lumen.language.diagnostics import did_you_mean
from lumen.language.projects import Project
from lumen.language.stories import Story
from lumen.loading.packaged import MAIN_FILE

FOLDER = Path("behaviors", "stories")


def home_of(words: Iterable[str]) -> str | None:
    """The project in whose `behaviors/stories/` the first of these files lies; None where none is such a file."""
    for word in words:
        file = Path(os.path.abspath(word))
        if _is_file(word) and len(file.parents) > 2 and (file.parents[2] / MAIN_FILE).is_file():
            return str(file.parents[2])
    return None


def stories_of(project: Project, word: str) -> Iterator[Story]:
    """The stories of a project that a word means: `shy`, `shy.yaml`, a path to that file, or `safety_*`.

    Raises UsageError where it means none: a file elsewhere is no story of the project, whatever its name.
    """
    if _is_file(word):
        yield _by_file(project, word)
        return
    found = [name for name in sorted(project.stories) if name == word or fnmatchcase(name, word)]
    if not found:
        hint = did_you_mean(word, project.stories, "behaviors/stories/ has")
        raise UsageError(f"no project or story `{word}`: {hint}")
    yield from (project.stories[name] for name in found)


def _is_file(word: str) -> bool:
    return word.endswith((".yaml", ".yml")) or "/" in word or os.sep in word


def _by_file(project: Project, word: str) -> Story:
    """The story in a file; its path is from here, from the project, or from its folder of stories."""
    folder = Path(os.path.abspath(project.root)) / FOLDER
    for base in (Path(), Path(project.root), folder):
        file = Path(os.path.abspath(base / word))
        if file.parent == folder and file.suffix == ".yaml" and file.stem in project.stories:
            return project.stories[file.stem]
    if Path(word).is_file():
        raise UsageError(f"{word} is not in {folder}: put it there, so that it is checked with the project")
    hint = did_you_mean(Path(word).stem, project.stories, "behaviors/stories/ has")
    raise UsageError(f"no story `{word}`: {hint}")
