"""`lumen hear`: a table for one state or for all listening states, and one line for an invalid request."""

import json
from pathlib import Path

import pytest

from lumen.cli.main import main
from tests.explaining.guide import guide_in
from tests.tables import for_each


@pytest.fixture(scope="module")
def root(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return guide_in(tmp_path_factory.mktemp("guide"))


def test_every_row_of_a_state_is_explained(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["hear", "Please don't sing", "--state", "choice", "--project", str(root)]
    assert main(words) == 0
    out, err = capsys.readouterr()
    assert err == ""
    assert out.splitlines()[0] == "choice"
    rows = [" ".join(line.split()) for line in out.splitlines()[2:-1]]
    assert rows[:4] == [
        "choice dance not found",
        "choice sing sing: “sing” 1 yes no negated",
        "→ choice not dance|sing sing: “sing” 1 yes no taken",
        "choice asked dance not found",
    ]
    assert rows[-1] == "offer else `not dance|sing` is taken before it"
    assert len(rows) == 8
    assert out.endswith("\n  `not dance|sing` is taken and leads to `bye`\n")


def test_without_a_state_every_state_that_hears_is_asked(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["hear", "show me the organ", "--project", str(root)]) == 0
    out, err = capsys.readouterr()
    assert err.startswith("each of the 5 states that hear in `guide`")
    assert "--state STATE shows one" in err
    blocks = out.split("\n\n")
    assert [block.split("\n")[0] for block in blocks] == ["ask_name", "offer", "choice", "offer.quiet", "quiz.ask"]
    assert "`tour_of` is taken and leads to `choice`\n    exhibits: pipe organ" in blocks[2]
    assert "dance" not in blocks[2]
    assert "`on heard` is taken and leads to `choice`" in blocks[3]


def test_it_ends_with_1_if_no_row_is_taken(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (root / "behaviors" / "deaf.yaml").write_text("states: {a: {hears: {greeting: a}}}\nwords: common\n", "utf-8")
    assert main(["hear", "a chair", "--behavior", "deaf", "--project", str(root)]) == 1
    out, err = capsys.readouterr()
    assert out == "a\n  no row is taken\n"
    assert err.startswith("the only state that hears in `deaf`")
    assert main(["hear", "Hello!", "--behavior", "deaf", "--project", str(root)]) == 0


def test_programs_get_one_object(root: Path, capsys: pytest.CaptureFixture[str]) -> None:
    words = ["hear", "exhibit four", "--state", "choice", "--language", "id", "--project", str(root)]
    assert main([*words, "--format", "json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert (found["text"], found["language"]) == ("exhibit four", "id")
    (state,) = found["states"]
    assert (state["state"], state["taken"]) == ("choice", "tour_of")
    (row,) = [row for row in state["rows"] if row["taken"]]
    assert row["caught"] == {"text": "exhibit four", "phrase": "exhibit four", "answer": None, "n": 4}
    assert row["found"] == {
        "name": "tour_of", "said": "exhibit four", "words": 1, "alone": None, "negated": False, "asked": False,
        "counts": True,
    }  # fmt: skip
    (sing,) = [row for row in state["rows"] if row["row"] == "sing"]
    assert sing["guard"] == {"text": "context.tries > 2", "holds": None, "error": None}


@for_each(
    ("words", "message"),
    [
        (["--state", "choise"], "no state `choise`: did you mean `choice`?"),
        (["--state", "bye"], "neither `bye` nor a state around it has `hears`: choose `ask_name`, `choice`"),
        (["--behavior", "gide"], "no behaviour `gide`: did you mean `guide`?"),
        (["--behavior", "still"], "no state of `still` has `hears`"),
        (["--language", "idd"], "no language `idd`: did you mean `id`?"),
    ],
)
def test_what_can_not_be_asked_is_one_line(
    root: Path, words: list[str], message: str, capsys: pytest.CaptureFixture[str]
) -> None:
    (root / "behaviors" / "still.yaml").write_text("states: {a: {after: {2s: a}}}\n", "utf-8")
    assert main(["hear", "dance", *words, "--project", str(root)]) == 2
    error = capsys.readouterr().err
    assert error.startswith(f"lumen hear: {message}")
    assert error.count("\n") == 1
