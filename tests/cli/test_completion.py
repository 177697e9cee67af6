"""Completion as bash, zsh and fish themselves perform it, and the parser's answers for unfinished words."""

import os
import pty
import select
import sys
from pathlib import Path

import pytest

from lumen.cli.main import main, subcommands
from tests import ROOT
from tests.guarded import Guarded, run_guarded
from tests.provided import program
from tests.tables import for_each
from tests.waiting import HANG, until

LIBRARIES = {name: value for name, value in os.environ.items() if name == "LD_LIBRARY_PATH"}
"""The path of libraries for shells that scripts/packages.sh has unpacked."""


def completed(capsys: pytest.CaptureFixture[str], *words: str) -> list[str]:
    assert main(["completion", "words", *(f".{word}" for word in words)]) == 0
    return [line.partition("\t")[0] for line in capsys.readouterr().out.splitlines()]


def test_verbs_are_completed(capsys: pytest.CaptureFixture[str]) -> None:
    assert completed(capsys, "") == [*subcommands(), "--help", "--version"]
    assert completed(capsys, "li") == ["lint"]


def test_options_are_completed_but_those_that_are_there(capsys: pytest.CaptureFixture[str]) -> None:
    assert completed(capsys, "lint", "--st") == ["--strict", "--stdin-filename"]
    assert completed(capsys, "lint", "--strict", "--st") == ["--stdin-filename"]
    assert completed(capsys, "lint", "--select", "speech", "--sel") == ["--select"]


@for_each(
    ("words", "some"),
    [
        (["lint", "--format", ""], "sarif"),
        (["run", "--story", "v"], "visitor"),
        (["run", "--speed", "4", "--story", "v"], "visitor"),
        (["test", "shy", "vis"], "visitor"),
        (["play", ""], "dance"),
        (["explain", "unknown-st"], "unknown-state"),
        (["run", "--language", ""], "id"),
        (["topic", "p"], "pub"),
        (["diff", ""], "live"),
        (["graph", ""], "tour"),
        (["graph", "--state", "go"], "goodbye"),
        (["export", "scxml", ""], "tour"),
    ],
    ids=" ".join,
)
def test_names_and_choices_are_completed(
    words: list[str], some: str, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(ROOT)
    assert some in completed(capsys, *words)


@pytest.mark.parametrize("words", [["frobnicate", ""], ["play", "dance", ""], ["lint", ""], ["plot", ""]])
def test_where_files_are_meant_or_nothing_is_known_the_shell_is_left_alone(
    words: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    assert completed(capsys, *words) == []


@pytest.fixture
def path(tmp_path: Path) -> str:
    """A PATH with `lumen` on it, for shells without a user."""
    lumen = tmp_path / "bin" / "lumen"
    lumen.parent.mkdir()
    lumen.write_text(f'#!/bin/sh\nPYTHONPATH="{ROOT / "engine"}" exec "{sys.executable}" -m lumen "$@"\n')
    lumen.chmod(0o755)
    return f"{lumen.parent}:/usr/local/bin:/usr/bin:/bin"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("shell", "begin"),
    [
        (["bash", "--norc", "--noprofile", "-i"], 'eval "$(lumen completion bash)"'),
        (["zsh", "-f", "-i"], 'autoload -Uz compinit; compinit -D -u; eval "$(lumen completion zsh)"'),
    ],
    ids=["bash", "zsh"],
)
def test_a_shell_completes_what_is_typed(shell: list[str], begin: str, path: str, tmp_path: Path) -> None:
    """On a pseudo-terminal, one press of Tab each completes the verb, the option and the story."""
    shell = [str(program(shell[0])), *shell[1:]]
    master, slave = pty.openpty()
    environment = {**LIBRARIES, "PATH": path, "HOME": str(tmp_path), "TERM": "dumb", "PS1": "$ "}
    with Guarded(shell, stdin=slave, stdout=slave, stderr=slave, env=environment, cwd=ROOT) as process:
        os.close(slave)
        os.write(master, f"{unpacked(shell[0])}{begin}; echo rea''dy\n".encode())
        assert "ready" in shown_until(master, "ready\r\n")
        os.write(master, b"lumen li\t")
        assert "lint" in shown_until(master, "lint")
        os.write(master, b"--stri\t")
        assert "--strict" in shown_until(master, "--strict")
        os.write(master, b"\x15lumen run --story visi\t")
        assert "visitor" in shown_until(master, "visitor")
        process.kill()
    os.close(master)


def unpacked(shell: str) -> str:
    """Return the settings of a zsh that scripts/packages.sh unpacked, which looks for its files in /usr."""
    root = Path(shell).parents[1]
    if not root.is_relative_to(ROOT) or Path(shell).name != "zsh":
        return ""
    return f"module_path=({root}/usr/lib/*/zsh/*); fpath=({root}/usr/share/zsh/functions/**/); setopt zle; "


def shown_until(terminal: int, wanted: str) -> str:
    """Return what a terminal shows until `wanted` is there."""
    shown = ""

    def read() -> None:
        nonlocal shown
        if select.select([terminal], [], [], 1.0)[0]:
            shown += os.read(terminal, 65536).decode(errors="replace")

    until(lambda: wanted in shown, meanwhile=read)
    return shown


@pytest.mark.slow
def test_fish_completes_with_what_it_means(path: str, tmp_path: Path) -> None:
    asked = (
        "lumen completion fish | source; complete -C 'lumen li'; complete -C 'lumen lint --stri'; complete -C 'lumen '"
    )
    environment = {**LIBRARIES, "PATH": path, "HOME": str(tmp_path), "TERM": "dumb"}
    command = [program("fish"), "--no-config", "-c", asked]
    done = run_guarded(command, env=environment, cwd=ROOT, capture_output=True, text=True, timeout=HANG)
    lines = done.stdout.splitlines()
    assert lines[:2] == ["lint\treport what is wrong in a project, and where", "--strict\tcount warnings as errors"]
    assert {line.partition("\t")[0] for line in lines[2:]} >= subcommands().keys()
