"""A new project, begun as a copy of one that comes with Lumen."""

import re
import shutil
from pathlib import Path, PurePosixPath

from lumen.project.main_file import main_settings
from lumen.project.packaged import shipped_root
from lumen.project.project_folders import MAIN_FILE, PROJECT_FOLDERS

STARTERS = {
    "tour": "the shipped exhibition, with everything",
    "museum": "a guide for five exhibits",
    "minimal": "a greeting, a gesture and a story, in 40 lines",
}
"""The projects that can be copied, with descriptions."""
EXAMPLES = "examples"
CHECKOUT = "actions/checkout@11bd71901bbe5b1630ceea73d27597364c9af683  # v4.2.2"
_SCHEMA = re.compile(r"(?m)^(# yaml-language-server: \$schema=)\S*?([\w.]+\.schema\.json)$")

_ROBOT = re.compile(r"(?m)^(robot: \{name: )\S+(, model: )\w+(\}).*$")

IGNORED = """\
# Data of runs, with the names of visitors. Do not share it.
.lumen/
# Videos that `lumen run --video` wrote.
*.mp4
"""

README = """\
# {name}

These files define what the robot does and says:

| file | holds |
| --- | --- |
{files}

    lumen run --story {story:<12} # a scripted visitor meets the robot, in simulation
    lumen run                      # be the visitor: type what you say
    lumen lint                     # what is wrong, and where
    lumen test                     # all stories, in seconds

Change a text while `lumen run` is running, and save: the robot says the new one. `lumen language add de` adds a
language. `.github/workflows/exhibition.yml` lints and tests what is pushed to GitHub.
"""
MEANINGS = {
    MAIN_FILE: "the robot, its languages, and the messages that it sends and receives",
    "behaviors": "what it does, as states; `stories` has scripted visitors, and what must happen",
    "behaviors/words": "what it says and listens for, by language",
    "behaviors/sayings": "what visitors say, and what must follow: `lumen test` tries each of them",
    "functions": "expressions with a name, which the other files use",
    "knowledge": "questions of visitors and their answers: one passage per file",
    "knowledge/questions": "other wordings of these questions: `lumen test` prints how many are answered",
    "fuzzy": "controllers, such as the one that turns the head to a face",
    "motions": "gestures",
    "sounds": "what it plays",
    "models": "the robot's body, and the hall of the simulation",
    "schemas": "the schemas of the files and messages: your editor uses them for completion",
}

WORKFLOW = """\
# Lints and tests this exhibition on GitHub with each push.
# {action} is Lumen's action: its repository, and the full hash of one of its commits.
name: exhibition
on: [push, pull_request]
permissions: {{contents: read}}
jobs:
  check:
    runs-on: ubuntu-latest
    steps:
      - uses: {checkout}
      - uses: {action}
        with: {{project: ., arguments: --strict}}
      - run: lumen test
"""


def start_project(folder: Path, like: str, action: str, robot: str = "") -> None:
    """Copy a starter into a folder, with a README, a .gitignore, and a workflow that uses `action`.

    `robot` is the body that performs it, one of `shipped_models`; empty for the starter's own. Raises OSError if a file
    can't be written.
    """
    folder.mkdir(parents=True, exist_ok=True)
    shipped = shipped_root()
    if like == "tour":
        shutil.copy(shipped / MAIN_FILE, folder)
        for name in (name for name in PROJECT_FOLDERS if (shipped / name).is_dir()):
            shutil.copytree(shipped / name, folder / name, dirs_exist_ok=True)
    else:
        ignored = shutil.ignore_patterns(".lumen", "__pycache__")
        shutil.copytree(shipped / EXAMPLES / like, folder, dirs_exist_ok=True, ignore=ignored)
        (folder / "schemas").mkdir(exist_ok=True)
        for schema in (shipped / "schemas").glob("*.schema.json"):
            shutil.copy(schema, folder / "schemas")
    if robot:
        _perform_with(folder, robot)
    for file in folder.rglob("*.yaml"):
        _lead_to_schemas(file, folder)
    (folder / ".gitignore").write_text(IGNORED, "utf-8")
    (folder / "README.md").write_text(_readme(folder), "utf-8")
    workflows = folder / ".github" / "workflows"
    workflows.mkdir(parents=True)
    (workflows / "exhibition.yml").write_text(WORKFLOW.format(action=action, checkout=CHECKOUT), "utf-8")


def _perform_with(folder: Path, robot: str) -> None:
    """Set the robot's name and body in lumen.yaml, and add the motions for the body that come with Lumen."""
    main = folder / MAIN_FILE
    main.write_text(_ROBOT.sub(rf"\g<1>{robot.capitalize()}\g<2>{robot}\g<3>", main.read_text("utf-8")), "utf-8")
    own = shipped_root() / "motions" / robot
    if own.is_dir():
        shutil.copytree(own, folder / "motions" / robot, dirs_exist_ok=True)


def _lead_to_schemas(file: Path, folder: Path) -> None:
    """Make a file's schema comment refer to this folder's schemas, at any depth."""
    up = PurePosixPath(*[".."] * len(file.parent.relative_to(folder).parts), "schemas")
    text = file.read_text("utf-8")
    if (led := _SCHEMA.sub(rf"\g<1>{up}/\g<2>", text)) != text:
        file.write_text(led, "utf-8")


def _readme(folder: Path) -> str:
    settings = main_settings(folder)
    assert settings is not None  # a starter has no errors
    there = {name: what for name, what in MEANINGS.items() if (folder / name).exists()}
    rows = "\n".join(f"| `{name}{'/' if (folder / name).is_dir() else ''}` | {what} |" for name, what in there.items())
    return README.format(name=settings.name, files=rows, story=settings.story)
