"""The package of examples/sprayer, which docs/architecture.md describes: installed and used."""

import re
import shutil
from collections.abc import Iterator
from contextlib import closing
from itertools import count
from pathlib import Path

import pytest
from scripts.rule_pages import said

import lumen
from lumen.errors import RobotFailedError
from lumen.feature import resolve
from lumen.insight.changes import changes
from lumen.language.commands import Do
from lumen.language.stories import Visitor
from lumen.lint import check_files
from lumen.lint.pages import page
from lumen.project.files import read_files
from lumen.robot.skill_runner import SkillRunner
from tests import ROOT
from tests.copying import copied_project
from tests.stranger.installing import call_lumen, install, used
from tests.tables import for_each
from tests.waiting import until

pytestmark = pytest.mark.process
SPRAYER = ROOT / "examples/sprayer"
MAIN, BEHAVIOR, STORY = "lumen.yaml", "behaviors/scents.yaml", "behaviors/stories/visitor.yaml"


@pytest.fixture(scope="module")
def sprayer_folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder into which the package is installed."""
    return install(SPRAYER, tmp_path_factory.mktemp("sprayer"))


@pytest.fixture(autouse=True)
def sprayer(sprayer_folder: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    with used(sprayer_folder, monkeypatch):
        yield


@pytest.fixture
def hall(tmp_path: Path) -> Path:
    """A copy of the project that uses the package."""
    return copied_project(SPRAYER / "hall", tmp_path / "hall")


def findings(root: Path) -> list[tuple[str, str, str]]:
    return [(each.place.file, str(each.code), each.message) for each in check_files(root, read_files(root))[1]]


def replace(file: Path, old: str, new: str) -> None:
    text = file.read_text("utf-8")
    assert old in text
    file.write_text(text.replace(old, new), "utf-8")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("words", "printed"),
    [
        ("--help", "Installed packages with features: lumen-sprayer 1.0."),
        ("lint --strict", "nothing wrong; 3 files checked"),
        ("test", "1 story, 0 failed"),
        ("test --real-skills", "1 story, 0 failed"),
        ("run --story visitor --robot recording --speed max", "does spray with duration 2s, nozzle left"),
        ("explain no-nozzle", "An action sprays from a nozzle that `sprayer` of lumen.yaml does not list."),
        ("graph", "hears my_name"),
        ("diff ../minimal .", "nozzle `left` added (wiring)"),
    ],
)
def test_the_commands_of_the_page_print_this(words: str, printed: str, hall: Path) -> None:
    shown = (ROOT / "docs/architecture.md").read_text("utf-8").replace("../../minimal", "../minimal")
    assert re.search(rf"^    lumen {re.escape(words)}( +#.*)?$", shown, re.MULTILINE)
    copied_project(ROOT / "examples/minimal", hall.parent / "minimal")
    done = call_lumen(hall, *words.split())
    assert done.returncode == 0, done.stderr
    assert printed in " ".join(done.stdout.split())
    assert done.stderr == ""


def test_diff_lists_a_changed_nozzle_and_a_changed_verb(hall: Path, tmp_path: Path) -> None:
    old = shutil.copytree(hall, tmp_path / "old")
    replace(hall / MAIN, "right: rose", "right: mint")
    replace(hall / BEHAVIOR, "nozzle: left", "nozzle: right")
    listed = [str(each) for each in changes(lumen.load(old), lumen.load(hall))]
    assert listed == [
        "state `spraying` now does `spray` with duration 2s, nozzle right",
        "nozzle `right` changed",
    ]


def test_the_project_is_sound(hall: Path) -> None:
    assert findings(hall) == []


@for_each(
    ("file", "old", "new", "code", "message"),
    [
        (BEHAVIOR, "nozzle: left", "nozzle: top", "no-nozzle", "there is no nozzle `top`"),
        (BEHAVIOR, "nozzle: left", "nozle: left", "unknown-key", "`nozle` is not a key of `spray`"),
        (BEHAVIOR, "nozzle: left", "nozzle: 3", "wrong-type", "`nozzle` should be a text, not a number"),
        (BEHAVIOR, "duration: 2s", "duration: 2 days", "bad-duration", "`2 days` is not a duration"),
        (BEHAVIOR, "{spray:", "{spary:", "unknown-key", "`spary` is not a key of item 1 of `do`"),
        (MAIN, "nozzles:", "nozles:", "unknown-key", "`nozles` is not a key of `sprayer`"),
        (MAIN, "left: lavender", "left: 3", "wrong-type", "`left` should be a text, not a number"),
        (STORY, "did: {spray:", "did: {spary:", "unknown-key", "`spary` is not a key of `did`"),
    ],
)
def test_lint_finds_mistakes(
    file: str, old: str, new: str, code: str, message: str, hall: Path, tmp_path: Path
) -> None:
    root = shutil.copytree(hall, tmp_path / "changed")
    replace(root / file, old, new)
    assert (file, code, message) in findings(root)


def test_a_nozzle_without_the_section_is_a_mistake(hall: Path) -> None:
    replace(hall / MAIN, "sprayer: {nozzles: {left: lavender, right: rose}}\n", "")
    assert findings(hall) == [(BEHAVIOR, "no-nozzle", "there is no nozzle `left`")]


def test_its_performer_reads_the_nozzles_of_the_section(hall: Path) -> None:
    sections, clock = lumen.load(hall).sections, count()
    with closing(SkillRunner()) as runner:
        top = runner.begin(Do("spray", {"duration": "2s", "nozzle": "top"}, sections), 0.0)
        with pytest.raises(RobotFailedError, match="there is no nozzle `top`"):
            until(lambda: top.advance(0.0))
        left = runner.begin(Do("spray", {"duration": "2s", "nozzle": "left"}, sections), 0.0)
        until(lambda: left.advance(next(clock)))
    assert left.result == {}


def test_the_page_of_the_code_shows_what_lint_finds() -> None:
    assert [str(each.code) for each in said(page("no-nozzle").wrong)] == ["no-nozzle"]
    assert said(page("no-nozzle").right) == []


def test_its_part_watches_the_steps_and_forgets_a_person(hall: Path) -> None:
    with lumen.open(hall, robot="recording") as exhibition:
        part = exhibition.services[resolve("lumen_sprayer.scents:ScentsPart")]
        exhibition.visitor.arrive(Visitor())
        exhibition.run(seconds=1)
        exhibition.visitor.speak("My name is Ani")
        exhibition.run(seconds=2)
        assert part.smelled == {"Ani": ["lavender"]}
        exhibition.services.bus.publish("lumen.NAO.persistence.forgotten", {"name": "Ani"})
        exhibition.run(seconds=1)
        assert part.smelled == {}
