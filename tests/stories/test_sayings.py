"""Sayings as tests: `lumen test` tries each in its state, and names the row that matched it instead."""

import json
import xml.etree.ElementTree as ET
from pathlib import Path

import pytest

import lumen
from lumen.cli.main import main
from lumen.insight.changes import changes
from lumen.insight.changes.change import Risk
from lumen.insight.explaining.sayings import tried
from lumen.language.sayings import Saying, SayingSet
from tests.explaining.guide import guide, guide_in
from tests.tables import for_each

GOOD = """\
guide:
  choice:
    dance: {en: ["Dance, please."], id: [Tolong menari]}
    not dance|sing: {en: [Please don't sing]}
    asked dance: {en: [Why do you dance?]}
    tour_of: {en: [{say: Show me the pipe organ, exhibits: Organ}, {say: exhibit three, n: 3}]}
    no|done: {id: [sudah]}
    else: {en: [Where is the exit?]}
  ask_name: {my_name: {en: [{say: I'm Budi, name: Budi}]}}
  quiz.ask: {exhibit.right: {en: [I think it is wood.]}}
"""
BAD = """\
guide:
  choice:
    sing: {en: [Sing!]}
    dance:
      en:
        - dance
        - What time is it?
        - Don't dance
    tour_of: {en: [{say: exhibit four, n: 3}]}
"""


def test_sayings_that_hold(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    root = guide_in(tmp_path, good=GOOD)
    assert main(["test", str(root)]) == 0
    assert capsys.readouterr().out == "\nsayings: 10 of 10 (100 %)\n"


def test_one_that_does_not_hold_is_named_with_its_place(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    root = guide_in(tmp_path, bad=BAD)
    assert main(["test", str(root)]) == 1
    assert capsys.readouterr().out.splitlines()[1:] == [
        "sayings: 1 of 5 (20 %)",
        "  behaviors/sayings/bad.yaml:3:17: “Sing!” in `choice`: `else` matches it, but `sing` should; the guard"
        " `context.tries > 2` of `sing` is false with the initial values of the context",
        "  behaviors/sayings/bad.yaml:7:11: “What time is it?” in `choice`: `else` matches it, but `dance` should",
        "  behaviors/sayings/bad.yaml:8:11: “Don't dance” in `choice`: `not dance|sing` matches it, but `dance` should;"
        " if `not dance|sing` is right, move this line under `not dance|sing`",
        "  behaviors/sayings/bad.yaml:9:20: “exhibit four” in `choice`: `n` is `4`, but should be `3`",
    ]


def test_a_name_means_files_of_sayings_as_it_means_stories(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    root = guide_in(tmp_path, good=GOOD, bad=BAD, god=GOOD)
    file = root / "behaviors" / "sayings" / "good.yaml"
    for words, count in (([root, "good"], 10), ([root, "go*"], 20), ([root, "good", "go*"], 20), ([file], 10)):
        assert main(["test", *map(str, words)]) == 0
        assert f"sayings: {count} of {count} " in capsys.readouterr().out
    assert main(["test", str(root), "goood"]) == 2
    assert "no project or story `goood`: did you mean `good`?" in capsys.readouterr().err


def test_of_several_answers_a_saying_names_one() -> None:
    faq = [{"phrases": {"en": ["which colour"]}, "value": {"en": ["Blue.", "White."]}}]
    machine = guide(answers={"faq": faq}, context={"tries": 1})

    def wrong(answer: str) -> str:
        saying = Saying("guide", "choice", "faq", "en", "Which colour?", {"answer": answer})
        (found,) = tried([SayingSet("colour", (saying,))], {"guide": machine})
        return found.wrong

    assert wrong("White.") == ""
    assert wrong("Red.") == "`answer` is `Blue. | White.`, but should be `Red.`"


def test_sayings_come_after_the_stories_unless_those_fail_first(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    root = guide_in(tmp_path, good=GOOD)
    (root / "behaviors" / "stories").mkdir()
    story = root / "behaviors" / "stories" / "good.yaml"
    story.write_text("steps: [{says: I'm Budi}, {expect: {state: choice}}]\n", "utf-8")
    assert main(["test", str(root), "good"]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith("ok ")
    assert lines[2] == "sayings: 10 of 10 (100 %)"
    assert lines[4].startswith("1 story and 10 sayings, 0 failed: ")
    saying = root / "behaviors" / "sayings" / "good.yaml"
    saying.write_text(GOOD.replace("Where is the exit?", "Please dance"), "utf-8")
    assert main(["test", str(root), "good"]) == 1
    assert capsys.readouterr().out.splitlines()[-1].startswith("1 story and 10 sayings, 1 failed: ")
    story.write_text("steps: [{says: I'm Budi}, {expect: {state: bye, within: 1s}}]\n", "utf-8")
    assert main(["test", str(root), "-x"]) == 1
    assert "sayings" not in capsys.readouterr().out


def test_programs_get_all_of_them(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    root = guide_in(tmp_path, bad=BAD)
    assert main(["test", str(root), "--format", "json"]) == 1
    sing, dance, *_ = json.loads(capsys.readouterr().out)["sayings"]
    assert dance == {
        "file": "behaviors/sayings/bad.yaml", "line": 6, "column": 11, "said": "dance", "behavior": "guide",
        "state": "choice", "language": "en", "row": "dance", "took": "dance", "passed": True,
    }  # fmt: skip
    assert (sing["passed"], sing["took"], sing["wrong"][:9]) == (False, "else", "`else` ma")
    assert main(["test", str(root), "--format", "junit"]) == 1
    (suite,) = ET.fromstring(capsys.readouterr().out)
    assert (suite.get("name"), suite.get("tests"), suite.get("failures")) == ("sayings", "5", "4")


@for_each(
    ("saying", "wrong"),
    [
        (Saying("guide", "bye", "else", "en", "hello"), "no row matches it, but `else` should"),
        (
            Saying("guide", "ask_name", "my_name", "en", "hm"),
            "`else` matches it, but `my_name` should; the guard `context.tries < 2` of `else` is true with the initial"
            " values of the context",
        ),
        (Saying("guide", "choice", "tour_of", "en", "exhibit one", {"exhibits": "clock"}),
         "`exhibits` is not caught, but should be `clock`"),
        (Saying("guide", "choice", "tour_of", "en", "show me the clock", {"exhibits": "organ", "n": 1}),
         "`exhibits` is `clock`, but should be `organ`; `n` is not caught, but should be `1`"),
        (Saying("guide", "offer.choice", "dance", "en", "dance"), ""),
    ],
)  # fmt: skip
def test_what_is_wrong_is_said(saying: Saying, wrong: str) -> None:
    (found,) = tried([SayingSet("a", (saying,))], {"guide": guide()})
    assert found.wrong == wrong


def test_saved_sayings_change_nothing_that_runs(tmp_path: Path) -> None:
    root = guide_in(tmp_path, good=GOOD)
    old = lumen.load(root)
    (root / "behaviors" / "sayings" / "good.yaml").write_text(GOOD.replace("please", "now"), "utf-8")
    (change,) = changes(old, new := lumen.load(root))
    assert (change.sentence, change.risk) == ("file of sayings `good` changed", Risk.COSMETIC)
    assert new.machine.hash == old.machine.hash
    (root / "behaviors" / "sayings" / "good.yaml").write_text(f"# a comment\n{GOOD}", "utf-8")
    assert changes(old, lumen.load(root)) == ()
