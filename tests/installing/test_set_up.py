"""The output of set-up and checks: one line if all is well, one sentence if something is missing."""

import re
import shutil
from pathlib import Path
from subprocess import CompletedProcess

import pytest

from tests import ROOT
from tests.guarded import run_guarded
from tests.waiting import HANG

PROGRAMS = ("sh", "cat", "grep", "tail", "mkdir", "rm", "touch", "dirname", "chmod", "ln")
NEW = """case "$*" in
*"version_info < "*) exit 0 ;;
*version_info*) echo 3.11; exit 0 ;;
*venv,*) exit ${NO_VENV:-0} ;;
"-m venv"*) mkdir -p .venv/bin; ln -s "$0" .venv/bin/python; exit 0 ;;
"-m pip"*) echo "WARNING: pip prints a lot"; echo "$PIP_SAYS"; exit ${PIP_ENDS:-0} ;;
esac
"""
OLD = """case "$*" in
--version) echo "Python 3.9.2" ;;
*) exit 1 ;;
esac
"""


class Checkout:
    """A folder with our scripts, and programs on its PATH: the usual ones and those given by their text."""

    def __init__(self, folder: Path, **programs: str) -> None:
        self.folder, self._programs = folder, folder / "bin"
        shutil.copytree(ROOT / "scripts", folder / "scripts", ignore=shutil.ignore_patterns("__pycache__"))
        shutil.copytree(ROOT / "locks", folder / "locks")
        self._programs.mkdir()
        for name in PROGRAMS:
            (self._programs / name).symlink_to(shutil.which(name) or name)
        for name, text in programs.items():
            self.write(self._programs / name, text)

    @staticmethod
    def write(program: Path, text: str) -> None:
        program.parent.mkdir(parents=True, exist_ok=True)
        program.write_text(f"#!/bin/sh\n{text}")
        program.chmod(0o755)

    def run(self, *words: str, **environment: str) -> "CompletedProcess[str]":
        return run_guarded(
            ["sh", *words],
            cwd=self.folder,
            env={"PATH": str(self._programs), **environment},
            capture_output=True,
            text=True,
            timeout=HANG,
        )


@pytest.mark.parametrize(
    ("stage", "begins"),
    [
        ("run", "setting up .venv for the engine and the simulated robot: "),
        ("test", "setting up .venv for the tests: "),
        ("docs", "setting up .venv for the documentation: "),
    ],
)
def test_one_line_says_what_is_installed(tmp_path: Path, stage: str, begins: str) -> None:
    checkout = Checkout(tmp_path, python3=NEW)
    checkout.run("scripts/set_up.sh", "run")
    done = checkout.run("scripts/set_up.sh", stage)
    assert (done.returncode, done.stderr) == (0, "")
    (line,) = done.stdout.splitlines()
    assert line.startswith(begins)
    assert re.search(r": \d\d+ Python packages, \d+ MB to download, ", line)
    assert (tmp_path / ".venv" / stage).exists()


@pytest.mark.parametrize(
    ("python", "environment", "said"),
    [
        ({}, {}, "Lumen needs Python 3.11 or later, and python3 is not there. Install one"),
        ({"python3": OLD}, {}, "Lumen needs Python 3.11 or later, and python3 is Python 3.9.2. Install one"),
        ({"python3": NEW}, {"NO_VENV": "1"}, "Python 3.11 is here, but its module venv is not. Install it"),
        (
            {"python3": NEW},
            {"PIP_ENDS": "1", "PIP_SAYS": "NewConnectionError: Temporary failure in name resolution"},
            "pip could not reach the package index: is there a network",
        ),
        (
            {"python3": NEW},
            {"PIP_ENDS": "1", "PIP_SAYS": "OSError: [Errno 28] No space left on device"},
            "The disk is full",
        ),
        (
            {"python3": NEW},
            {"PIP_ENDS": "1", "PIP_SAYS": "ERROR: No matching distribution found for labmaze"},
            "A package cannot be had for Python 3.11 on this machine.",
        ),
    ],
    ids=["no_python", "an_old_python", "no_venv", "no_network", "a_full_disk", "no_such_package"],
)
def test_a_sentence_says_what_is_missing(
    tmp_path: Path, python: dict[str, str], environment: dict[str, str], said: str
) -> None:
    done = Checkout(tmp_path, **python).run("scripts/set_up.sh", "run", **environment)
    assert done.returncode == 1
    (line,) = done.stderr.splitlines()
    assert line.startswith(said)
    assert not (tmp_path / ".venv/run").exists()


def test_another_python_of_the_machine_serves_where_python3_is_too_old(tmp_path: Path) -> None:
    assert Checkout(tmp_path, **{"python3": OLD, "python3.12": NEW}).run("scripts/set_up.sh", "run").returncode == 0


def test_whatever_else_pip_fails_of_is_printed(tmp_path: Path) -> None:
    done = Checkout(tmp_path, python3=NEW).run("scripts/set_up.sh", "run", PIP_ENDS="1", PIP_SAYS="ERROR: it broke")
    assert done.stderr.splitlines()[-2:] == [
        "ERROR: it broke",
        "pip failed; all that it printed is in .cache/set_up.log.",
    ]


def test_checks_that_are_well_print_a_line_and_one_that_fails_all_that_it_printed(tmp_path: Path) -> None:
    checkout = Checkout(tmp_path)
    for tool in ("ruff", "mypy", "lint-imports", "python"):
        checkout.write(tmp_path / ".venv/bin" / tool, "echo Success: 1 file")
    done = checkout.run("scripts/check.sh")
    assert (done.returncode, done.stdout) == (0, "style, types, floors, order and prose: well\n")
    checkout.write(tmp_path / ".venv/bin/mypy", "echo a.py: error; echo and a hint >&2; exit 1")
    done = checkout.run("scripts/check.sh")
    assert done.returncode == 1
    assert done.stdout.splitlines() == ["--- types: .venv/bin/mypy", "a.py: error", "and a hint", "not well: types"]
