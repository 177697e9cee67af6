"""Every command that installs Lumen, in the documents and in Lumen's messages, installs it."""

import json
import re
import shlex
import tomllib
from collections.abc import Iterator
from pathlib import Path

import installed_size as installing
import pytest
from packaging.requirements import Requirement

from tests import ROOT
from tests.guarded import run_guarded
from tests.scanning import matching
from tests.waiting import HANG

pytestmark = [pytest.mark.xdist_group("installing"), pytest.mark.slow]
PAGES = (
    "README.md",
    "CONTRIBUTING.md",
    "lumen.yaml",
    "docs/**/*.md",
    "examples/**/*.md",
    "examples/**/*.y*ml",
    "engine/**/*.py",
)
WORD = r"""(?:'[^'\n]*'|"[^"\n]*"|[^\s`'"),;:]+)"""
COMMAND = re.compile(rf"pip install ((?:--no-deps )?(?!-){WORD})")
FOREIGN = {"dm-control>=1.0.50,<2", "uv"}
REPOSITORY = "lumen-robot @ git+https://github.com/OWNER/lumen@COMMIT"
"""The placeholder of the address of a copy of Lumen, and of a commit in it."""


def lines() -> Iterator[tuple[str, str]]:
    """Yield the page and the words after `pip install` of each such line."""
    for pattern in PAGES:
        for page in matching(ROOT, pattern):
            for found in COMMAND.finditer(page.read_text()):
                if "{extra}" not in found[1]:
                    yield str(page.relative_to(ROOT)), found[1]


def words(line: str, wheel: Path) -> list[str]:
    """Return pip's arguments for a line: the wheel replaces the checkout, the wheel's file and the repository."""
    replaced = []
    for word in shlex.split(line):
        extras = re.search(r"\[[\w,-]*\]", word)
        ours = word.startswith((".", "dist/lumen_robot-", "lumen-robot")) and not word.startswith("lumen-robot[")
        assert " @ " not in word or re.sub(r"\[.*?\]", "", word) == REPOSITORY, word
        replaced.append(f"{wheel}{extras[0] if extras else ''}" if ours else word)
    return replaced


LINES = sorted({line for _, line in lines()})


def test_there_are_such_lines_and_all_name_what_can_be_installed() -> None:
    assert len(LINES) > 8
    for page, line in lines():
        ours = [word for word in shlex.split(line) if not word.startswith("--")]
        known = re.compile(r"(\.|dist/lumen_robot-0\.1\.0-py3-none-any\.whl|lumen-robot)(\[[\w,-]+\])?( @ git\+.*)?$")
        assert all(known.match(word) or word in FOREIGN for word in ours), f"{page}: pip install {line}"
        if page.startswith(("README", "docs")) and "[" not in line:
            assert ours != ["lumen-robot"], f"{page}: Lumen is in no index, which `pip install {line}` asks"


@pytest.mark.parametrize("some", ["show", pytest.param(".", marks=pytest.mark.soak)])
def test_all_that_they_ask_for_can_be_had_together_by_who_has_the_core(
    some: str, core: Path, wheel: Path, tmp_path: Path
) -> None:
    """`lumen-robot[plot]` is found since the core is installed, in whatever way; nothing is installed by this."""
    asked = {word for line in LINES for word in words(line, wheel) if word.startswith("lumen-robot[")}
    assert asked >= {"lumen-robot[simulation]", "lumen-robot[plot]", "lumen-robot[eyes]", "lumen-robot[show]"}
    names = planned(tmp_path, "--python", str(core), "install", *(word for word in asked if re.search(some, word)))
    assert "paho-mqtt" in names
    assert "lumen-robot" not in names


def asked_on(version: str) -> list[str]:
    """Return the packages that core, simulation and plots require there; pip evaluates markers for its own Python."""
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    extras = project["optional-dependencies"]
    lines = [*project["dependencies"], *extras["simulation"], *extras["plot"]]
    ours = [Requirement(line) for line in lines]
    there = [one for one in ours if not one.marker or one.marker.evaluate({"python_version": version})]
    return [f"{one.name}{one.specifier}" for one in there]


def test_what_has_no_wheel_for_3_13_is_not_asked_for_there() -> None:
    more, less = ({Requirement(line).name for line in asked_on(version)} for version in ("3.13", "3.12"))
    assert (more - less, less - more) == ({"dm-env", "dm-tree", "lxml"}, {"dm-control"})


@pytest.mark.soak
@pytest.mark.parametrize("version", ["3.12", "3.13"])
def test_each_python_gets_wheels_only(version: str, tmp_path: Path) -> None:
    target = ("install", "--target", str(tmp_path / "none"), "--python-version", version, "--only-binary=:all:")
    names = planned(tmp_path, *target, *asked_on(version))
    assert ("dm-control" in names) == ("labmaze" in names) == (version == "3.12")
    assert names >= {"mujoco", "dm-env", "dm-tree", "lxml", "numpy", "pygls"}


def test_dm_control_is_pinned_for_every_python_and_labmaze_where_it_has_a_wheel() -> None:
    text = (ROOT / "locks/run.txt").read_text()
    rows = re.findall(r"(?m)^(?:dm-control|labmaze)==[^\\\n]+", text)
    dm_control, labmaze = map(Requirement, rows)
    assert dm_control.marker is None
    assert labmaze.marker
    assert [labmaze.marker.evaluate({"python_full_version": f"3.{minor}.0"}) for minor in (11, 12, 13, 14)] == [
        True, True, False, False]  # fmt: skip


def planned(folder: Path, *command: str) -> set[str]:
    """Return the names of the packages that pip would install."""
    report = folder / "report.json"
    more = ("--dry-run", "--report", str(report))
    done = run_guarded([*installing.PIP, *command, *more], timeout=HANG, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr[-1500:]
    return {item["metadata"]["name"].lower().replace("_", "-") for item in json.loads(report.read_text())["install"]}


@pytest.mark.soak
@pytest.mark.parametrize("line", LINES)
def test_each_line_installs_into_an_empty_environment_what_can_then_be_imported(
    line: str, wheel: Path, tmp_path: Path
) -> None:
    python = installing.environment(tmp_path / "empty")
    if "lumen-robot[" in line and "@" not in line:
        installing.install(python, str(wheel))  # add it to the installed packages
    installing.install(python, *words(line, wheel))
    module = "dm_control.mjcf" if "dm-control" in line else "lumen.cli.main"
    if "dm-control" in line:
        installing.install(python, f"{wheel}[simulation]")
    done = run_guarded([python, "-c", f"import {module}"], cwd=tmp_path, timeout=HANG, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
