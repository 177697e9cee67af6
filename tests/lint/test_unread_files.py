"""Every file that a person puts into a project's folders is read, or reported with the name of the right place."""

from pathlib import Path

import pytest

from lumen.lint import check
from tests import ROOT
from tests.copying import copied_project
from tests.tables import for_each

HERE = Path(__file__).parent
REPORTED = [
    ("motions/reachy_mini/lief/calm.yaml", "did you mean `motions/reachy_mini/life/`?"),
    ("motions/nao/old/dance.yaml", "move the files that belong to the exhibition to motions/"),
    ("motions/life/nao/calm.yaml", "move the files to motions/nao/life/"),
    ("motions/gestures/nao/guide.yaml", "move the files to motions/nao/gestures/"),
    ("motions/nao/gesture/guide.yaml", "did you mean `motions/nao/gestures/`?"),
    ("motions/life/old/calm.yaml", "move the files that belong to the exhibition to motions/life/"),
    ("motions/gesture/guide.yaml", "did you mean `motions/gestures/`?"),
    ("motions/live/calm.yaml", "did you mean `motions/life/`?"),
    ("motions/nao/deep/er/bow.yaml", "move the files that belong to the exhibition to motions/"),
    ("behaviors/storys/visit.yaml", "did you mean `behaviors/stories/`?"),
    ("behaviors/sayins/a.yaml", "did you mean `behaviors/sayings/`?"),
    ("behaviors/word/faq.yaml", "did you mean `behaviors/words/`?"),
    ("behaviors/motions/bow.yaml", "move the files to motions/"),
    ("behaviors/parts/tour.yaml", "move the files that belong to the exhibition to behaviors/"),
    ("behaviors/stories/old/visit.yaml", "move the files that belong to the exhibition to behaviors/stories/"),
    ("behaviors/words/en/faq.yaml", "move the files that belong to the exhibition to behaviors/words/"),
    ("knowledge/question/a.yaml", "did you mean `knowledge/questions/`?"),
    ("knowledge/en/loom.md", "move the files that belong to the exhibition to knowledge/"),
    ("fuzzy/head/head.yaml", "move the files that belong to the exhibition to fuzzy/"),
    ("functions/old/f.yaml", "move the files that belong to the exhibition to functions/"),
    ("models/passage/sit-stand.yaml", "did you mean `models/passages/`?"),
    ("skills/old/spray.yaml", "move the files that belong to the exhibition to skills/"),
    ("schemas/message/face.schema.json", "did you mean `schemas/messages/`?"),
    ("schemas/messages/old/face.schema.json", "move the files that belong to the exhibition to schemas/messages/"),
    ("schemas/face.schema.json", "move it to schemas/messages/, if it describes one"),
    ("schemas/messages/face.json", "rename it to face.schema.json"),
    ("schemas/messages/face.shema.json", "rename it to face.schema.json"),
    ("schemas/messages/face.yaml", "rename it to face.schema.json"),
    ("motons/bow.yaml", "did you mean `motions/`?"),
    ("behavors/tour.yaml", "did you mean `behaviors/`?"),
    ("skill/spray.yaml", "did you mean `skills/`?"),
    ("questions/a.yaml", "did you mean `knowledge/questions/`?"),
    ("messages/face.schema.json", "did you mean `schemas/messages/`?"),
    ("driver/mine.py", "did you mean `drivers/`?"),
    ("motions/bow.yalm", "rename it to bow.yaml"),
    ("motions/bow.ymal", "rename it to bow.yaml"),
    ("motions/bow.json", "rename it to bow.yaml"),
    ("motions/bow", "rename it to bow.yaml"),
    ("motions/nao/bow.yalm", "rename it to bow.yaml"),
    ("motions/nao/life/calm.yalm", "rename it to calm.yaml"),
    ("behaviors/stories/visit.yam", "rename it to visit.yaml"),
    ("knowledge/loom.markdown", "rename it to loom.md"),
    ("knowledge/loom.txt", "rename it to loom.md"),
    ("skills/spray.yalm", "rename it to spray.yaml"),
    ("fuzzy/head.yml", "rename it to head.yaml, or delete it"),
    ("fuzzy/head.YAML", "rename it to head.yaml"),
    ("motions/nao/bow.YAML", "rename it to bow.yaml"),
    ("motions/nao/Life/calm.yaml", "did you mean `motions/nao/life/`?"),
]
RIGHT = [
    "motions/README.md", "motions/LICENSE", "motions/.bow.yaml.new", "motions/bow.yaml~", "motions/bow.yaml.bak",
    "motions/bow.png", "motions/sounds/bow.wav", "motions/bow.motion", "models/meshes/arm.obj",
    "models/parts/arm.xml", "models/README.md", "knowledge/README.txt", "skills/package.json", "skills/spray.py",
    "skills/spray", "skills/lib/help.py", "skills/lib/deep/data.yaml", "skills/__pycache__/spray.pyc",
    "drivers/mine.py", "tests/bow.yaml", "docs/motion.yaml", "notes/tour.yaml", "schemas/motion.schema.json",
    "examples/lumen.yaml", "motion-sources/a.txt", "behaviors/draft/lumen.yaml", ".github/workflows/test.yaml",
    "docker-compose.yaml",
]  # fmt: skip


@pytest.fixture(scope="module")
def project(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A small project with all of these files."""
    root = tmp_path_factory.mktemp("unread") / "hall"
    copied_project(ROOT / "examples/minimal", root)
    for file in (*RIGHT, *(file for file, _ in REPORTED)):
        (root / file).parent.mkdir(parents=True, exist_ok=True)
        (root / file).write_text("")
    return root


def hints(project: Path) -> dict[str, list[str]]:
    """The hints of all files that are not read."""
    found: dict[str, list[str]] = {}
    for finding in check(project):
        if finding.code == "not-read":
            found.setdefault(finding.place.file, []).append(finding.hint)
    return found


@for_each(("file", "hint"), REPORTED)
def test_a_file_that_is_not_read_is_reported_once(tmp_path: Path, file: str, hint: str) -> None:
    root = tmp_path / "hall"
    if not root.exists():
        copied_project(ROOT / "examples/minimal", root)
    (root / file).parent.mkdir(parents=True, exist_ok=True)
    (root / file).write_text("")
    try:
        assert hints(root) == {file: [hint]}
    finally:
        (root / file).unlink()


def test_a_copy_of_a_file_that_is_read_is_left_alone(tmp_path: Path) -> None:
    root = tmp_path / "hall"
    copied_project(ROOT / "examples/minimal", root)
    read = next((root / "behaviors").glob("*.yaml"))
    for copy in (read.with_suffix(""), read.with_suffix(".yalm"), read.with_suffix(".json")):
        copy.write_text("")
    assert hints(root) == {}


def test_files_of_other_programs_are_left_alone(project: Path) -> None:
    assert hints(project).keys().isdisjoint(RIGHT)


def test_the_shipped_projects_have_none() -> None:
    for root in (ROOT, ROOT / "examples/reachy", ROOT / "examples/museum", ROOT / "examples/skills"):
        assert hints(root) == {}
