"""Every verb has a correct page, examples that can be typed, and an object for programs."""

import json
import shlex
from pathlib import Path

import pytest
from scripts.command_pages import DOCS, written

from lumen.cli.main import command_line, main, subcommands
from lumen.cli.pages import page
from lumen.cli.suggesting import parse
from tests.scanning import matching
from tests.tables import for_each

NO_REPORT = {"completion": "prints a script", "lsp": "speaks the protocol of editors", "console": "shows pages"}
"""Verbs without `--format json`, and what they do instead of reporting."""


def test_the_pages_are_those_that_the_parser_makes() -> None:
    there = {file.name: file.read_text(encoding="utf-8") for file in matching(DOCS, "*.md")}
    assert there == written(), "call `python scripts/command_pages.py`"


@for_each("verb", subcommands())
def test_examples_can_be_typed(verb: str) -> None:
    parser, examples = command_line([verb]), page(verb).examples
    assert examples, f"engine/lumen/cli/pages/{verb}.md begins with examples"
    for one in examples:
        program, *words = shlex.split(one.command)
        assert (program, words[0]) == ("lumen", verb)
        assert parse(parser, words).verb == verb
    assert f"  {examples[0].command}\n" in parser.verbs[verb].format_help()


@for_each("verb", subcommands())
def test_what_is_reported_is_an_object_too_and_its_page_says_which(verb: str) -> None:
    formats = [a.choices for a in command_line([verb]).verbs[verb]._actions if "--format" in a.option_strings]
    assert (verb in NO_REPORT) != any("json" in (choices or ()) for choices in formats)
    assert (verb in NO_REPORT) != ("## JSON\n" in page(verb).text)


@pytest.mark.process
@pytest.mark.parametrize(
    ("words", "keys"),
    [
        (["lint"], {"diagnostics", "files"}),
        (["test", "shy"], {"stories", "failed", "took"}),
        (["explain", "unknown-state"], {"code", "family", "severity", "summary", "what", "why", "wrong", "right"}),
        (["schema"], {"kinds"}),
        (["diff", "."], {"old", "new", "summary", "risk", "changes"}),
        (
            ["run", "--robot", "recording", "--speed", "max", "--story", "shy"],
            {"ended", "project", "story", "time", "took", "failure", "summary", "film"},
        ),
    ],
    ids=lambda words: words[0] if isinstance(words, list) else "",
)
def test_an_object_has_the_keys_that_its_page_names(
    words: list[str], keys: set[str], copy: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(copy)
    assert main([*words, "--format", "json"]) == 0
    assert json.loads(capsys.readouterr().out).keys() == keys
    assert all(key in page(words[0]).text for key in keys)


@pytest.mark.process
def test_a_run_tells_on_standard_error_and_says_how_it_ended(copy: Path, capsys: pytest.CaptureFixture[str]) -> None:
    story = copy / "behaviors/stories/shy.yaml"
    story.write_text(story.read_text().replace("did not hear your name", "never said this", 1))
    said = ["--robot", "recording", "--speed", "max", "--story", "shy", "--format", "json"]
    code = main(["run", str(copy), *said])
    out, err = capsys.readouterr()
    verdict = json.loads(out)
    assert (code, verdict["ended"], verdict["story"]) == (1, "failed", "shy")
    assert verdict["failure"] in err
    assert out.count("\n") == 1


@for_each(
    ("words", "answer"),
    [
        (["lnt"], "no verb `lnt`: did you mean `lint`?"),
        (["lsit"], "no verb `lsit`: did you mean `lint`?"),
        (["frobnicate"], "no verb `frobnicate`; --help lists them"),
        (["lint", "--stirct"], "no option `--stirct`: did you mean `--strict`?"),
        (["run", "--vidoe=x.mp4"], "no option `--vidoe`: did you mean `--video`?"),
        (["export", "mermiad"], "invalid FORMAT `mermiad`: did you mean `mermaid`?"),
        (["lint", "--format", "jsn"], "invalid `--format jsn`: did you mean `json`?"),
        (["explain", "tab", "more"], "unexpected word `more`"),
    ],
    ids=lambda words: " ".join(words) if isinstance(words, list) else "",
)
def test_a_word_that_is_misspelt_is_answered_with_what_was_meant(
    words: list[str], answer: str, capsys: pytest.CaptureFixture[str]
) -> None:
    with pytest.raises(SystemExit) as ended:
        main(words)
    assert ended.value.code == 2
    assert answer in capsys.readouterr().err


def test_an_unknown_option_before_the_verb_is_compared_with_its_options(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit, match="2"):
        main(["--strickt", "lint"])
    assert "did you mean `--strict`?" in capsys.readouterr().err
