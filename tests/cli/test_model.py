"""`lumen model on` and `off`, to an exhibition that has a language model and to one that has none."""

import json
from pathlib import Path

import pytest

from lumen.cli.main import main
from lumen.cli.person import person
from lumen.run.exhibition import Exhibition

ANSWERS = '  answers: {model: {url: "http://127.0.0.1:9/v1/chat/completions", name: none}}'


@pytest.fixture
def copy(copy: Path) -> Path:
    """A copy that uses a language model whose URL no server answers."""
    file = copy / "lumen.yaml"
    file.write_text(file.read_text("utf-8").replace("\nmodules:\n", f"\nmodules:\n{ANSWERS}\n"), "utf-8")
    return copy


@pytest.fixture
def without(copy: Path) -> None:
    """Removes the language model from the copy."""
    file = copy / "lumen.yaml"
    file.write_text(file.read_text("utf-8").replace(ANSWERS, ""), "utf-8")


@pytest.mark.network
def test_it_is_silenced_by_who_says_so_and_speaks_again(
    exhibition: Exhibition, copy: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    questions = exhibition.loop.performer.questions
    assert main(["model", "off", str(copy)]) == 0
    assert capsys.readouterr().out == "the language model is off\n"
    assert questions.silenced == person()
    assert main(["model", "on", str(copy), "--format", "json"]) == 0
    assert json.loads(capsys.readouterr().out) == {"ok": True, "answer": "the language model is on"}
    assert questions.silenced == ""


@pytest.mark.network
@pytest.mark.usefixtures("without")
def test_where_there_is_none_it_says_so(exhibition: Exhibition, copy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["model", "off", str(copy)]) == 1
    assert "has no language model: lumen.yaml has no module `answers`" in capsys.readouterr().err
    assert exhibition.loop.performer.questions.silenced == ""
    with pytest.raises(SystemExit):
        main(["model", "maybe", str(copy)])
    assert "invalid STATE `maybe`: choose one of `off`, `on`" in capsys.readouterr().err
