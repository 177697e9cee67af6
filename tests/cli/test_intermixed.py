"""Options are accepted before, between and after the other words of a command."""

import pytest

from lumen.cli.main import main


@pytest.mark.parametrize(
    "words",
    [["mermaid", "tour", "--project", "."], ["mermaid", "--project", ".", "tour"], ["--project", ".", "mermaid"]],
)
def test_options_stand_anywhere(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["export", *words]) == 0
    assert capsys.readouterr().out.startswith("stateDiagram-v2")


@pytest.mark.parametrize("words", [["export"], ["export", "mermaid", "tour", "more"], ["test", "--no-such"], ["lnt"]])
def test_what_is_wrong_ends_with_two(words: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(words)
    assert ended.value.code == 2
    assert "usage: lumen" in capsys.readouterr().err


@pytest.mark.process
def test_what_stands_behind_two_dashes_is_no_option(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["diff", "--", "--x"]) == 2
    assert "`--x` is not a folder" in capsys.readouterr().err
