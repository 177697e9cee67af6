"""Behaviours that are invoked, in stories: `first/ask` is the state `ask` of what runs as `first`."""

from collections.abc import Callable
from pathlib import Path

import pytest

from lumen.cli.main import main

FAQ = """\
id: faq
context: {asked: 0}
initial: asking
states:
  asking:
    do: {say: Ask me.}
    on: {heard: answering}
  answering:
    do: [{say: It depends.}, {assign: {asked: context.asked + 1}}]
    onDone: [{guard: context.asked >= 2, target: enough}, asking]
    onError: enough
  enough: {type: final}
"""
HOST = """\
events: {start: null, turn: null}
initial: waiting
states:
  waiting: {on: {start: faqs, turn: passed}}
  faqs: {invoke: {behavior: faq, id: first, onDone: over}}
  passed: {always: waiting}
  over: {after: {5s: waiting}}
"""

Story = Callable[..., Path]


@pytest.fixture
def host(copy: Path) -> Story:
    (copy / "behaviors" / "faq.yaml").write_text(FAQ, "utf-8")
    (copy / "behaviors" / "host.yaml").write_text(HOST, "utf-8")

    def write(steps: str, head: str = "", name: str = "asked") -> Path:
        text = f"behavior: host\n{head}steps:\n{steps}"
        (copy / "behaviors" / "stories" / f"{name}.yaml").write_text(text, "utf-8")
        return copy

    return write


def told(folder: Path, code: int, capsys: pytest.CaptureFixture[str], *more: str) -> str:
    assert main(["test", str(folder), "asked", *more]) == code
    return capsys.readouterr().out


BOTH = """\
  - event: start
  - expect: {state: [faqs, first/asking], said: ask me}
  - says: Why?
  - expect: {state: first/answering}
  - expect: {state: first/asking}
  - says: And when?
  - expect: {state: over}
"""


def test_a_state_inside_is_expected_and_told(host: Story, capsys: pytest.CaptureFixture[str]) -> None:
    shown = told(host(BOTH), 0, capsys, "--coverage", "-v")
    lines = [line.split("state ", 1)[1].strip() for line in shown.splitlines() if " state " in line and ":0" in line]
    assert lines == [
        "waiting  (at the start)",
        "faqs  (start)",
        "first/asking  (at the start)",
        "first/answering  (heard)",
        "first/asking  (done)",
        "first/answering  (heard)",
        "first/enough  (done, as context.asked >= 2)",
        "over  (done)",
    ]
    assert "behaviors/faq.yaml:11:14: `answering` failed, to `enough` is never taken" in shown


def test_never_counts_inside_and_in_passing(host: Story, capsys: pytest.CaptureFixture[str]) -> None:
    shown = told(host(BOTH, "never: [first/enough]\n"), 1, capsys)
    assert "asked.yaml:10:5: step 7: expected never state `first/enough`, but it was entered" in shown
    shown = told(host("  - event: turn\n  - wait: 1s\n", "never: [passed]\n"), 1, capsys)
    assert "expected never state `passed`, but it was entered" in shown


def test_a_name_that_is_not_there(host: Story, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["test", str(host("  - expect: {state: first/askin}\n")), "asked"]) == 1
    said = capsys.readouterr().err
    assert "asked.yaml:3:21: error [unknown-state] `host` has no state `first/askin`" in said
    assert "did you mean `first/asking`?" in said
    assert main(["test", str(host("  - expect: {state: faq/asking}\n")), "asked"]) == 1
    assert "did you mean `first/asking`?" in capsys.readouterr().err


def test_what_exploring_finds_inside_is_a_story(host: Story, capsys: pytest.CaptureFixture[str]) -> None:
    folder = host("  - wait: 1s\n")
    faq = folder / "behaviors" / "faq.yaml"
    faq.write_text(FAQ.replace("    onError: enough\n", ""), "utf-8")
    assert main(["test", str(folder), "--explore", "--behavior", "host"]) == 1
    shown = capsys.readouterr().out
    assert "no transition leads out of `faqs` with `first/answering`" in shown
    found = shown.partition("    # yaml-language-server")[2].split("\n\n")[0].splitlines()
    story = "\n".join([f"# yaml-language-server{found[0]}", *(line[4:] for line in found[1:])])
    (folder / "behaviors" / "stories" / "asked.yaml").write_text(story + "\n", "utf-8")
    assert "first/answering" in story
    told(folder, 0, capsys)
