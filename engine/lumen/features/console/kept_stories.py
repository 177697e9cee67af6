"""Stories saved from the page Day, which turn recorded visits into tests in behaviors/stories/."""

from datetime import datetime
from pathlib import Path
from typing import NamedTuple

import lumen
from lumen.errors import UsageError
from lumen.insight.replay.visits import RecordedVisit, visits
from lumen.project.project_folders import STORIES
from lumen.run.new_passage import create_file
from lumen.run.one_robot import one_robot
from lumen.run.replaying.journals import KeptBundles, chosen
from lumen.run.replaying.other_files import with_machines
from lumen.run.storytelling.story_text import story_text
from lumen.run.storytelling.visit_story import renaming, visit_story

MAX_SAME = 100
"""The maximum number of stories of visits that began in the same minute."""


class KeptStory(NamedTuple):
    """A story that was written from a recorded visit."""

    file: Path
    """The path of its file, relative to the project's folder."""
    remark: str
    """The recorded actions and those with today's files; empty if they are the same."""


def keep_story(root: Path, position: int, robot: str = "", *, visitor: str = "", name: str = "") -> KeptStory:
    """Write the story of the recorded visit that has the entry at `position`.

    The story replaces the name `visitor` by `name`, and overwrites no file. Raises UsageError if no visit has that
    entry, the visit is redacted or incomplete, `name` is missing, or the file can't be written.
    """
    visitor, name = " ".join(visitor.split()), " ".join(name.split())
    if visitor and not name:
        raise UsageError(f"write another name for {visitor}: a story is kept for years")
    robot = one_robot(root, robot)
    project, bundles = lumen.load(root, robot=robot), KeptBundles(root, robot)
    visit = _visit(root, position, robot, bundles)
    old = bundles.project(visit.home.bundle, visit.home.behavior) if visit.home else None
    if old is None:
        raise UsageError("the journal does not have the whole visit, or the files that ran then were not kept")
    began = datetime.fromtimestamp(visit.began)
    title, stem = f"A visit on {began:%Y-%m-%d} at {began:%H:%M}", f"visit_{began:%Y_%m_%d_%H%M}"
    names = renaming({visitor: name} if visitor else {})
    made = visit_story(project, old, visit, name=stem, title=title, renamed=names)
    remark = "" if made.same else f"then: {made.was}; with the files of today: {made.now}"
    remarks = ["Kept from the console. It contains what people said: check it for names."]
    text = story_text(made.story, [*remarks, f"The robot does something else here, {remark}."] if remark else remarks)
    return KeptStory(_created(root, stem, text), remark)


def _visit(root: Path, position: int, robot: str, bundles: KeptBundles) -> RecordedVisit:
    """Return the visit that has the entry at `position`. Raises UsageError if there is none or it is redacted."""
    recorded = visits(with_machines(chosen(root, None, all=True, robot=robot).entries(), bundles))
    for visit in recorded:
        if visit.first <= position <= visit.last:
            if visit.redacted:
                raise UsageError("this visit is redacted: a visitor in it was forgotten, and the words are gone")
            return visit
    raise UsageError("the journal has no visit at this position")


def _created(root: Path, stem: str, text: str) -> Path:
    """Write a story to a new file, and return its path in the project. Raises UsageError if it can't be written."""
    folder = root / STORIES
    try:
        folder.mkdir(parents=True, exist_ok=True)
        if folder.is_symlink():
            raise UsageError(f"{STORIES}/ is a symbolic link: replace it with a folder")
        for number in range(1, MAX_SAME + 1):
            file = folder / f"{stem}{f'_{number}' if number > 1 else ''}.yaml"
            if create_file(file, text):
                return file.relative_to(root)
    except OSError as error:
        raise UsageError(f"{STORIES}/ can't be written: {error.strerror}") from None
    raise UsageError(f"{MAX_SAME} stories already have this name: rename some of them")
