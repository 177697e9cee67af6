"""Words change from one vocabulary to the next: files are rewritten where the word stands, and nowhere else."""

import json
from collections.abc import Iterator, Mapping
from pathlib import Path

import pytest
import yaml

from lumen.cli.main import main
from lumen.errors import UsageError
from lumen.language.vocabulary import VOCABULARY
from lumen.lint import check_files
from lumen.lint.robot_keys import with_robot_keys
from lumen.lint.upgrading import MIGRATIONS, Migration, Rewriting, renamed_key, upgraded
from lumen.project import settings
from lumen.project.document import Document
from lumen.project.files import read_files
from tests import ROOT
from tests.copying import copied_project
from tests.tables import for_each

BASE = ROOT / "tests/lint/base"


def polite(document: Document) -> Iterator[Rewriting]:
    """Yield a change that is more than a key: vocabulary 3 says `please` where 2 said `now`."""
    if document.file.startswith("motions/") and document.data.get("when") == "now":
        yield Rewriting(document.place(("when",)), "`when: now` is `when: please` now", "please")


MADE_UP: Mapping[int, tuple[Migration, ...]] = {
    1: (
        renamed_key("behaviors/*.yaml", ("states", "*", "do"), "perform"),
        renamed_key("lumen.yaml", ("hall",), "room"),
    ),
    2: (polite,),
}
"""Two steps of a fictitious vocabulary: from 1 to 2, and from 2 to 3."""
FILES = {
    "lumen.yaml": b"# the museum\r\nbehavior: tour # the only one\r\nhall: hall.xml\r\n",
    "behaviors/tour.yaml": (
        b"states:\n  greet:   # at the door\n    'do': {say: do}\n    on: {do: bye}\n"
        b"  bye: {do: [], entry: {}}   # do\n"
    ),
    "behaviors/stories/do.yaml": b"states: {a: {do: 1}}\n",
    "motions/wave.yaml": b"when: now  # at once\n",
    "schemas/messages/x.schema.json": b"{}",
}


def test_words_are_rewritten_where_they_stand_and_comments_stay() -> None:
    after, done = upgraded(FILES, MADE_UP, 3)
    assert after == FILES | {
        "lumen.yaml": b"# the museum\r\nlumen: 3\r\nbehavior: tour # the only one\r\nroom: hall.xml\r\n",
        "behaviors/tour.yaml": (
            b"states:\n  greet:   # at the door\n    perform: {say: do}\n    on: {do: bye}\n"
            b"  bye: {perform: [], entry: {}}   # do\n"
        ),
        "motions/wave.yaml": b"when: please  # at once\n",
    }
    assert [f"{each.place.file}:{each.place.line} {each.why}" for each in done] == [
        "behaviors/tour.yaml:3 `do` is now called `perform`",
        "behaviors/tour.yaml:5 `do` is now called `perform`",
        "lumen.yaml:3 `hall` is now called `room`",
        "motions/wave.yaml:1 `when: now` is `when: please` now",
        "lumen.yaml:2 the vocabulary is now 3",
    ]


def test_a_key_of_manifests_of_skills_is_renamed_and_their_code_stays(tmp_path: Path) -> None:
    root = copied_project(ROOT / "tests/features/skills/project", tmp_path)
    after, done = upgraded(read_files(root), {1: (renamed_key("skills/*.yaml", ("in", "required"), "needs"),)}, 2)
    assert b"in:\n  needs: [duration]" in after["skills/spray.yaml"]
    assert [f"{each.place.file}:{each.place.line} {each.why}" for each in done[:1]] == [
        "skills/spray.yaml:3 `required` is now called `needs`"
    ]
    assert not [file for file in after if file.endswith(".py")]


def test_steps_begin_at_the_number_that_the_files_say_and_once_is_enough() -> None:
    files = FILES | {"lumen.yaml": b"lumen: 2   # since spring\nhall: hall.xml\n"}
    after, done = upgraded(files, MADE_UP, 3)
    assert after["lumen.yaml"] == b"lumen: 3   # since spring\nhall: hall.xml\n"
    assert after["behaviors/tour.yaml"] == files["behaviors/tour.yaml"]
    assert len(done) == 2
    assert upgraded(after, MADE_UP, 3) == (after, [])


@for_each(
    ("files", "said"),
    [
        (
            {"lumen.yaml": b"lumen: 4\n"},
            "is written for vocabulary 4, but this Lumen supports 3: install a newer Lumen",
        ),
        ({"lumen.yaml": b"lumen: soon\n"}, "the vocabulary in lumen.yaml is invalid"),
        ({"lumen.yaml": b"lumen: true\n"}, "the vocabulary in lumen.yaml is invalid"),
        ({"lumen.yaml": b"lumen: 0\n"}, "the vocabulary in lumen.yaml is invalid"),
        ({"lumen.yaml": b"- a\n"}, "the vocabulary in lumen.yaml is invalid"),
        ({"lumen.yaml": b"{}\n"}, "is empty"),
        ({"lumen.yaml": b"a: [\n"}, "lumen.yaml can't be read, so nothing is rewritten"),
        (
            {"lumen.yaml": b"? a\n: 1\n"},
            "lumen.yaml can't be rewritten automatically: write `lumen: 3` as its first key",
        ),
        ({}, "lumen.yaml can't be read, so nothing is rewritten"),
        ({**FILES, "behaviors/b.yaml": b'a: "\n'}, "behaviors/b.yaml can't be read, so nothing is rewritten"),
        (
            {**FILES, "lumen.yaml": b"hall: a\nroom: b\n"},
            "lumen.yaml:1: `hall` is now called `room`, but the file has both: delete one of them",
        ),
    ],
)
def test_what_can_not_be_rewritten_is_told_and_left(files: dict[str, bytes], said: str) -> None:
    with pytest.raises(UsageError) as raised:
        upgraded(files, MADE_UP, 3)
    assert said in str(raised.value)


@pytest.mark.parametrize("main", [b"a: 1\n", b"{a: 1}\n", b"---\n# x\n  a: 1\n  b: {c: 2}\n", b"\xef\xbb\xbfa: 1"])
def test_the_number_is_written_before_all_else_however_the_file_is_laid_out(main: bytes) -> None:
    after, _ = upgraded({"lumen.yaml": main})
    was, now = (yaml.safe_load(text.decode("utf-8-sig")) for text in (main, after["lumen.yaml"]))
    assert now == {"lumen": VOCABULARY} | was
    assert next(iter(now)) == "lumen"


@pytest.mark.parametrize("project", ["", "examples/museum", "examples/erratum"])
def test_the_shipped_projects_say_what_they_are_written_for(project: str) -> None:
    files = read_files(ROOT / project)
    assert upgraded(files) == (files, [])


def test_what_leads_to_the_vocabulary_of_this_lumen_is_known_from_every_older_one() -> None:
    assert sorted(MIGRATIONS) == list(range(1, VOCABULARY))


def test_a_file_without_the_number_is_of_the_first(monkeypatch: pytest.MonkeyPatch) -> None:
    """A Lumen of a later vocabulary reports it as an older file."""
    files = read_files(BASE)
    assert check_files(BASE, files)[1] == ()
    monkeypatch.setattr(settings, "VOCABULARY", 2)
    (found,) = check_files(BASE, files)[1]
    assert (str(found.code), found.place.file) == ("other-vocabulary", "lumen.yaml")
    assert "written for vocabulary 1, but this Lumen supports 2" in found.message
    assert found.hint == "run `lumen upgrade`: it rewrites the files and prints the changes"
    stated = files | {"lumen.yaml": b"lumen: 2\n" + files["lumen.yaml"]}
    assert check_files(BASE, stated)[1] == ()


def test_of_newer_files_nothing_else_is_said() -> None:
    files = {"lumen.yaml": b"lumen: 2\nflavour: sweet\nbehavior: none\n", "behaviors/a.yaml": b"moods: {}\n"}
    (found,) = check_files(BASE, files)[1]
    assert (str(found.code), found.place[1:3]) == ("other-vocabulary", (1, 8))
    assert "install a newer Lumen" in found.hint


def test_the_command_says_what_it_changed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for name, content in read_files(BASE).items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_bytes(content)
    before = (tmp_path / "lumen.yaml").read_bytes()
    assert main(["upgrade", str(tmp_path), "--check"]) == 1
    assert main(["upgrade", str(tmp_path), "--diff"]) == 0
    assert "\n+lumen: 1\n" in capsys.readouterr().out
    assert (tmp_path / "lumen.yaml").read_bytes() == before
    assert main(["upgrade", str(tmp_path), "--check", "--format", "json"]) == 1
    assert json.loads(capsys.readouterr().out) == {
        "vocabulary": 1,
        "rewritten": [{"file": "lumen.yaml", "line": 1, "why": "the vocabulary is now 1"}],
        "errors": None,
    }
    assert main(["upgrade", str(tmp_path)]) == 0
    said = capsys.readouterr().out
    assert "the vocabulary is now 1\n1 place rewritten; the files now use vocabulary 1\n" in said
    assert (tmp_path / "lumen.yaml").read_bytes() != before
    assert main(["upgrade", str(tmp_path), "--check"]) == 0
    assert main(["lint", "--strict", str(tmp_path)]) == 0
    assert main(["upgrade", str(tmp_path), "--check", "--diff"]) == 2


OLD_KEYS = b"""\
lumen: 1
routes:
  # who is heard
  heard: {key: lumen.audio.speech.recognition, direction: in}  # who
  face:
    key: 'lumen.visual.face.detection'   # one of them
    direction: in
  lamp: {key: museum.lamp, direction: out}
  gender: {key: lumen.audio.gender.identification, alias: my.gender, direction: in}
"""
NEW = b"""\
lumen: 1
routes:
  # who is heard
  heard: {key: "lumen.{robot}.audio.speech.recognition", alias: lumen.audio.speech.recognition, direction: in}  # who
  face:
    key: "lumen.{robot}.visual.face.detection"
    alias: lumen.visual.face.detection   # one of them
    direction: in
  lamp: {key: museum.lamp, direction: out}
  gender: {key: lumen.audio.gender.identification, alias: my.gender, direction: in}
"""


@pytest.mark.parametrize("line_break", [b"\n", b"\r\n"])
def test_keys_of_2015_get_the_robot_and_stay_as_aliases(line_break: bytes) -> None:
    files = {"lumen.yaml": OLD_KEYS.replace(b"\n", line_break), "motions/a.yaml": b"a: 1\n"}
    after, done = with_robot_keys(files)
    assert after == files | {"lumen.yaml": NEW.replace(b"\n", line_break)}
    assert [f"{each.place.line} {each.why}" for each in done] == [
        "4 the key of `heard` now contains the robot's name; its alias is the old key `lumen.audio.speech.recognition`",
        "6 the key of `face` now contains the robot's name; its alias is the old key `lumen.visual.face.detection`",
    ]
    assert with_robot_keys(after) == (after, [])


@pytest.mark.parametrize(
    "routes",
    [
        b"  a: &a {key: lumen.presence}\n  b: {<<: *a}\n",
        b"  a: {key: &k lumen.presence}\n  b: {key: *k}\n",
        b"  a: {? key : lumen.presence}\n",
        b"  a: {key: >-\n      lumen.presence\n    }\n",
    ],
)
def test_what_is_laid_out_otherwise_is_right_or_left(routes: bytes) -> None:
    """No rewritten file changes its meaning."""
    files = {"lumen.yaml": b"routes:\n" + routes}
    try:
        after, _ = with_robot_keys(files)
    except UsageError:
        return
    was, now = (yaml.safe_load(each["lumen.yaml"])["routes"] for each in (files, after))
    renewed = {"key": "lumen.{robot}.presence", "alias": "lumen.presence"}
    assert now == {name: {**row, **renewed} for name, row in was.items()}


def test_the_command_offers_it_and_does_it_when_asked(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    for name, content in read_files(ROOT / "examples/minimal").items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_bytes(content)
    main_file = tmp_path / "lumen.yaml"
    row = "heard: {key: lumen.audio.speech.recognition, direction: in, schema: speech.recognition, event: heard}"
    text = main_file.read_text("utf-8")
    main_file.write_text(f"lumen: 1\n{text}routes:\n  {row}\n", "utf-8")
    before = main_file.read_bytes()
    assert main(["upgrade", str(tmp_path), "--check"]) == 0
    assert "1 key from 2015 would reach several robots: run `lumen upgrade --keys`\n" in capsys.readouterr().out
    assert main_file.read_bytes() == before
    assert main(["upgrade", str(tmp_path), "--check", "--keys"]) == 1
    assert main(["upgrade", str(tmp_path), "--keys"]) == 0
    new = '"lumen.{robot}.audio.speech.recognition", alias: lumen.audio.speech.recognition'
    assert new in main_file.read_text("utf-8")
    assert main(["upgrade", str(tmp_path), "--check", "--keys"]) == 0
