"""Lint's stored results for each file are equal to the results of a new run."""

from pathlib import Path

import pytest

from lumen.lint import check_files
from lumen.project import looks, memoization
from lumen.project.files import read_files
from lumen.run.linting.kept_memory import MUCH, keep_memory, recall_memory
from tests.copying import copied_project

BASE = Path(__file__).parent / "base"
TOUR = "behaviors/tour.yaml"


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A project without stored results, whose files count as settled."""
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    monkeypatch.setattr(looks, "SETTLED_NS", -(10**18))
    forget(monkeypatch)
    return copied_project(BASE, tmp_path / "project")


def forget(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(memoization, "_last", {})
    monkeypatch.setattr(memoization, "_unpacked", set())
    monkeypatch.setattr(memoization, "_asked", set())


@pytest.mark.parametrize(
    ("file", "old", "new"),
    [
        (TOUR, "onError: idle", "onError: idel"),
        (TOUR, "id: tour", "id: tour # of the hall"),
        ("lumen.yaml", "story: hello", "story: helo"),
        ("motions/wave.yaml", "{", "{{"),
    ],
)
def test_what_is_remembered_says_the_same(
    file: str, old: str, new: str, project: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    check_files(project, read_files(project))
    keep_memory(project)
    path = project / file
    path.write_text(path.read_text().replace(old, new, 1))
    forget(monkeypatch)
    anew = check_files(project, read_files(project))
    forget(monkeypatch)
    recall_memory(project)
    again = check_files(project, read_files(project))
    assert again == anew
    assert 0.0 <= memoization.newly_made() < 1.0


FLAG = """\
id: flag
context: {{on: {value}}}
types: {{on: {{enum: {choice}}}}}
states: {{hall: {{on: {{face: {{target: hall, guard: context.on}}}}}}}}
"""
NUMBERS = FLAG.format(value=1, choice=[0, 1])
TRUTHS = FLAG.format(value="true", choice="[false, true]")


def test_a_finding_in_an_expression_is_remembered_as_it_was(project: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = project / "behaviors/flag.yaml"
    path.write_text(NUMBERS)
    anew = check_files(project, read_files(project))
    (found,) = (each for each in anew[1] if each.place.file == "behaviors/flag.yaml" and each.severity == "error")
    assert found.message == "this is a number, but true or false is needed here"
    keep_memory(project)
    forget(monkeypatch)
    recall_memory(project)
    lumen_yaml = project / "lumen.yaml"
    lumen_yaml.write_text(lumen_yaml.read_text() + "# edited\n")
    assert check_files(project, read_files(project))[1] == anew[1]


def test_numbers_are_not_taken_for_truth_values(tmp_path: Path) -> None:
    files = {"lumen.yaml": b"behavior: flag\n"}
    for text in (NUMBERS, TRUTHS, NUMBERS, TRUTHS):
        found = check_files(tmp_path, {**files, "behaviors/flag.yaml": text.encode()})[1]
        errors = [each.code for each in found if each.severity == "error" and each.place.file == "behaviors/flag.yaml"]
        assert errors == (["type-mismatch"] if text == NUMBERS else [])


DANCE = b"keyframes: [{play: bowing, at: 0s}, {at: 1s, joints: {HeadYaw: 0.1}}]\n"
WAVE = b"keyframes: [{at: 1s, joints: {HeadYaw: 0.1}}]\n"


def test_the_hint_for_an_unknown_motion_is_from_the_motions_that_are_there(project: Path) -> None:
    for name in ("bowings", "throwing"):
        files = {**read_files(project), "motions/dance.yaml": DANCE, f"motions/{name}.yaml": WAVE}
        (found,) = (each for each in check_files(project, files)[1] if "`bowing`" in each.message)
        assert f"`{name}`" in found.hint


TALK = b"""id: talk
words: [words]
states:
  hall:
    hears: {dance: hall}
    states:
      desk: {hears: {faq: desk}}
"""
WORDS = b"""phrases:
  dance: {en: [tower]}
answers:
  faq:
    - {phrases: {en: [tower]}, value: {en: It is old.}}
    - {phrases: {en: [door]}, value: {en: It is new.}}
"""


def test_a_row_and_a_table_of_one_name_are_tried_apart(tmp_path: Path) -> None:
    files = {"behaviors/talk.yaml": TALK, "behaviors/words/words.yaml": WORDS}
    for content in (TALK, TALK.replace(b"id: talk", b"id: talk # of the hall")):
        found = check_files(tmp_path, {**files, "behaviors/talk.yaml": content})[1]
        assert [(each.code, str(each.place)) for each in found if each.place.file.endswith("words.yaml")] == [
            ("shadowed-phrase", "behaviors/words/words.yaml:2:16")
        ]


def test_of_the_same_files_nothing_is_made_anew(project: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    check_files(project, read_files(project))
    keep_memory(project)
    forget(monkeypatch)
    recall_memory(project)
    check_files(project, read_files(project))
    assert memoization.newly_made() < MUCH


def test_of_files_that_were_saved_just_now_nothing_is_kept(
    project: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    check_files(project, read_files(project))
    monkeypatch.setattr(looks, "SETTLED_NS", 10**18)
    keep_memory(project)
    assert not (tmp_path / "cache/lumen/memory").exists()


def test_only_what_was_asked_for_is_kept(project: Path, tmp_path: Path) -> None:
    memoization.memoize("another project", 1, lambda: "x" * 100_000)
    recall_memory(project)
    check_files(project, read_files(project))
    keep_memory(project)
    (kept,) = (tmp_path / "cache/lumen/memory").iterdir()
    assert b"another project" not in kept.read_bytes()


@pytest.mark.parametrize("content", [b"", b"\n", b'{"paths": {}, "packages": {}}\nnonsense', b"[]\n"])
def test_what_is_kept_badly_is_as_good_as_nothing(
    content: bytes, project: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    check_files(project, read_files(project))
    keep_memory(project)
    (kept,) = (tmp_path / "cache/lumen/memory").iterdir()
    kept.write_bytes(content)
    forget(monkeypatch)
    recall_memory(project)
    assert memoization.newly_made() == 0.0
    assert not memoization._last
