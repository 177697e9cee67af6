"""A recorded visit made into a story passes at once, and fails if the robot says something else."""

import json
import os
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from random import Random
from typing import Any

import pytest

import lumen
from lumen.cli.main import main
from lumen.insight.replay.visits import RecordedVisit, visits
from lumen.journal.redaction import redact
from lumen.language.people import PersonName
from lumen.language.projects import Project
from lumen.language.stories import Expect, Speak
from lumen.lint import check_files
from lumen.project.files import read_files
from lumen.run.rehearsal import rehearse
from lumen.run.replaying.journals import KeptBundles, chosen
from lumen.run.replaying.other_files import with_machines
from lumen.run.storytelling.story_text import story_text
from lumen.run.storytelling.visit_story import renaming, visit_story
from tests import ROOT
from tests.copying import copied_project

pytestmark = pytest.mark.rest  # expensive

EXAMPLES = {"tour": ROOT, "museum": ROOT / "examples/museum", "minimal": ROOT / "examples/minimal"}
LONG = {
    *(("tour", f"endless_{what}") for what in ("motion", "song", "speech")),
    ("tour", "silent_visitors"),
    ("tour", "slow_speech"),
    *(("tour", name) for name in ("safety_endless_wake", "safety_resume")),
    *(("museum", name) for name in ("closing", "german")),
}
"""Stories of many minutes, or with several visits, which only `make soak` tries."""
SAMPLE = 8
"""The number of other stories that are tried; `LUMEN_TEST_SEED=5` draws others."""


def shipped() -> Iterator[Any]:
    found = [
        (name, file.stem) for name, at in EXAMPLES.items() for file in sorted((at / "behaviors/stories").glob("*.yaml"))
    ]
    short = [one for one in found if one not in LONG]
    drawn = Random(int(os.environ.get("LUMEN_TEST_SEED", "18"))).sample(short, min(SAMPLE, len(short)))
    for one in found:
        yield pytest.param(*one, marks=[] if one in drawn else [pytest.mark.soak])


@pytest.fixture(scope="module")
def copies(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """Copies in which visits can be recorded."""
    folder = tmp_path_factory.mktemp("copies")
    return {name: copied_project(root, folder / name) for name, root in EXAMPLES.items()}


def recorded(folder: Path, story: str) -> list[RecordedVisit]:
    with lumen.open(folder, story=story) as exhibition:
        exhibition.run()
    bundles = KeptBundles(folder)
    return list(visits(with_machines(chosen(folder, None).entries(), bundles)))


def read(folder: Path, text: str) -> Project:
    """Return the project with that story as `found`; fail if lint has a finding about it."""
    files = {**read_files(folder), "behaviors/stories/found.yaml": text.encode()}
    project, findings = check_files(folder, files)
    assert project, findings
    assert not [one for one in findings if "found.yaml" in one.place.file]
    return project


@pytest.mark.slow
@pytest.mark.parametrize(("name", "story"), list(shipped()))
def test_every_visit_of_the_shipped_stories_is_a_story_that_passes(
    copies: dict[str, Path], name: str, story: str
) -> None:
    folder = copies[name]
    project, bundles = lumen.load(folder), KeptBundles(folder)
    found = recorded(folder, story)
    assert found
    for visit in found:
        assert visit.home
        old = bundles.project(visit.home.bundle, visit.home.behavior)
        assert old
        made = visit_story(project, old, visit, name="found", title="Found")
        # whoever comes second hears other words of those that take turns
        assert made.same or visit.number > 1, (made.was, made.now)
        told = read(folder, story_text(made.story, ["of a test"]))
        rehearsal = rehearse(told, told.stories["found"])
        assert rehearsal.failed is None, rehearsal.failed
        assert told.stories["found"].steps == made.story.steps
        _fails_where_something_else_is_said(told)


def _fails_where_something_else_is_said(project: Project) -> None:
    """Check that a story fails if any of its expected texts is replaced."""
    story = project.stories["found"]
    for i, step in enumerate(story.steps):
        if isinstance(step.action, Expect) and step.action.said:
            other = replace(step, action=replace(step.action, said="something else"))
            failed = rehearse(project, replace(story, steps=(*story.steps[:i], other, *story.steps[i + 1 :]))).failed
            assert failed
            assert failed.step == i + 1
            return


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    folder = copied_project(ROOT / "examples/minimal", tmp_path / "minimal")
    assert recorded(folder, "visitor")
    return folder


def ask(folder: Path, *words: str) -> int:
    return main(["story", "--project", str(folder), *words])


def test_a_story_is_written_passes_and_fails_once_the_robot_says_something_else(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    output = folder / "behaviors" / "stories" / "kept.yaml"
    assert ask(folder, "--at", "10:00", "-o", str(output)) == 0
    text = output.read_text("utf-8")
    assert "# The visit from 10:00:" in text
    assert "says: Goodbye!" in text
    assert "said: Goodbye!" in text
    assert main(["test", str(folder), "kept"]) == 0
    behavior = folder / "behaviors" / "hello.yaml"
    behavior.write_text(behavior.read_text("utf-8").replace("en: Goodbye!", "en: So long!"), "utf-8")
    assert main(["test", str(folder), "kept"]) == 1
    capsys.readouterr()
    assert ask(folder, "-o", str(output)) == 2
    assert "already exists: name another file, or add --force" in capsys.readouterr().err
    assert ask(folder, "-o", str(output), "--force", "--format", "json") == 1, "it says something else now"
    said = json.loads(capsys.readouterr().out)
    assert (said["same"], said["was"], said["is"]) == (False, "“Goodbye!” (en)", "“So long!” (en)")
    assert "# With today's files, the robot does something else" in output.read_text("utf-8")
    assert main(["test", str(folder), "kept"]) == 0, "what it does now is what is expected"


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["--at", "13:00"], "no visit was under way at 13:00; the nearest was from 10:00:"),
        (["--at", "25:00"], "`25:00` is not a time of day"),
        (["--name", "Budi"], "write two names, such as `--name Budi=Ani`"),
        (["--at", "10:00", "-o", "/dev/null/x/y.yaml"], "can't write"),
        (["2001-01-01"], "there is no journal of 2001-01-01"),
    ],
)
def test_what_can_not_be(folder: Path, capsys: pytest.CaptureFixture[str], words: list[str], told: str) -> None:
    capsys.readouterr()
    assert ask(folder, *words) == 2
    assert told in capsys.readouterr().err


def test_who_is_forgotten_is_in_no_story(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for file in (folder / ".lumen").rglob("*.journal"):
        redact(file, PersonName("Goodbye"))
    capsys.readouterr()
    assert ask(folder) == 2
    assert "is redacted: a visitor in it was forgotten" in capsys.readouterr().err


@pytest.mark.slow
def test_another_name_is_written_wherever_it_is_said(copies: dict[str, Path]) -> None:
    folder = copies["tour"]
    project, bundles = lumen.load(folder), KeptBundles(folder)
    (visit,) = recorded(folder, "not_fine")
    assert visit.home
    old = bundles.project(visit.home.bundle, visit.home.behavior)
    assert old
    name = next(
        step.action.text.split()[-1]
        for step in project.stories["not_fine"].steps
        if isinstance(step.action, Speak) and step.action.text.lower().startswith("my name is")
    )
    made = visit_story(project, old, visit, name="found", title="t", renamed=renaming({name: "Ratna"}))
    assert made.same
    text = story_text(made.story, [])
    assert name not in text
    assert "Ratna" in text
