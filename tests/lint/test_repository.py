"""Lint in a repository: the hook of pre-commit, and the GitHub action."""

import json
import re
import shutil
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
import yaml

from lumen.project.files import read_files
from lumen.project.project_folders import FLEET_FILE, FOLDERS
from tests import ROOT
from tests.copying import copied_project
from tests.guarded import CompletedProcess, run_guarded
from tests.provided import program
from tests.waiting import HANG

BASE = Path(__file__).parent / "base"
HOOK: dict[str, Any] = yaml.safe_load((ROOT / ".pre-commit-hooks.yaml").read_text())[0]
ACTION: dict[str, Any] = yaml.safe_load((ROOT / "action.yml").read_text())


@pytest.fixture
def repository(tmp_path: Path) -> Path:
    """A git repository with a project in a folder of it, `lumen` on its PATH."""
    return made(tmp_path, "stand")


def made(home: Path, *projects: str) -> Path:
    """Return a git repository with staged projects in these folders; `lumen` and `pre-commit` are on its PATH."""
    repository = home / "repository"
    for folder in projects:
        copied_project(BASE, repository / folder)
    bin_folder = home / "bin"
    bin_folder.mkdir()
    for name, module in (("lumen", "lumen"), ("pre-commit", "pre_commit")):
        program = bin_folder / name
        program.write_text(f'#!/bin/sh\nPYTHONPATH="{ROOT / "engine"}" exec "{sys.executable}" -m {module} "$@"\n')
        program.chmod(0o755)
    git(repository, "init", "-q")
    git(repository, "add", ".")
    return repository


def git(folder: Path, *words: str) -> str:
    who = ("-c", "user.name=Ada", "-c", "user.email=ada@example.org")
    done = run_guarded([program("git"), *who, *words], cwd=folder, check=True, capture_output=True, text=True)
    return str(done.stdout).strip()


def spoil(folder: Path) -> None:
    file = folder / "behaviors" / "tour.yaml"
    file.write_text(file.read_text().replace("onError: idle", "onError: idel"))


def shell(command: str, folder: Path, **environment: str) -> CompletedProcess[str]:
    tools = next(parent / "bin" for parent in folder.parents if (parent / "bin" / "lumen").is_file())
    environment["PATH"] = f"{tools}:/usr/bin:/bin"
    words = ["bash", "-c", command]
    return run_guarded(words, cwd=folder, env=environment, capture_output=True, text=True, timeout=HANG, check=False)


def test_the_hook_has_what_pre_commit_asks_for() -> None:
    assert {"id", "name", "entry", "language", "files"} <= HOOK.keys()
    assert HOOK["id"] == "lumen-lint"


def test_the_hook_runs_for_every_file_of_a_project_and_no_other() -> None:
    files = re.compile(HOOK["files"])
    shipped = [*read_files(ROOT), FLEET_FILE]
    kinds = [f"{folder.path}/café{ending}" for folder in FOLDERS for ending in folder.endings]
    assert not [file for file in (*shipped, *kinds) if not files.search(file)]
    assert all(files.search(f"stand/{file}") for file in shipped if not file.startswith("schemas"))
    assert not [file for file in ("README.md", "engine/lumen/bus.py", "docs/yaml.md", "a.yaml") if files.search(file)]


@pytest.fixture(scope="module")
def hooks(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    """A repository that has our hook, as pre-commit clones it, and its commit."""
    folder = tmp_path_factory.mktemp("hooks")
    shutil.copy(ROOT / ".pre-commit-hooks.yaml", folder)
    git(folder, "init", "-q")
    git(folder, "add", ".")
    git(folder, "commit", "-q", "-m", "Adds a hook")
    return folder, git(folder, "rev-parse", "HEAD")


@pytest.fixture
def commit(hooks: tuple[Path, str], tmp_path: Path) -> Callable[[Path], CompletedProcess[str]]:
    """A function that runs pre-commit on all staged files. `language: system` keeps it from installing anything."""
    source, revision = hooks

    def commit(repository: Path) -> CompletedProcess[str]:
        hook = {"id": "lumen-lint", "language": "system"}
        config = {"repos": [{"repo": source.as_uri(), "rev": revision, "hooks": [hook]}]}
        (repository / ".pre-commit-config.yaml").write_text(yaml.safe_dump(config))
        git(repository, "add", ".")
        return shell("pre-commit run", repository, PRE_COMMIT_HOME=str(tmp_path / "cache"), HOME=str(tmp_path))

    return commit


@pytest.mark.slow
@pytest.mark.parametrize("folders", [["."], ["stand"], ["halls/first", "halls/second"]])
def test_pre_commit_stops_what_breaks_any_project_of_a_repository(
    folders: list[str], tmp_path: Path, commit: Callable[[Path], CompletedProcess[str]]
) -> None:
    repository = made(tmp_path, *folders)
    assert "Passed" in (sound := commit(repository)).stdout, sound
    for folder in folders:
        spoil(repository / folder)
    broken = commit(repository)
    assert broken.returncode == 1
    for folder in folders:
        assert f"{Path(folder, 'behaviors/tour.yaml')}:28:14: error[unknown-state]" in broken.stdout


@pytest.mark.slow
def test_pre_commit_judges_what_a_file_breaks_in_others(
    repository: Path, commit: Callable[[Path], CompletedProcess[str]]
) -> None:
    """The file that is committed has nothing wrong in it: the one that names it has."""
    git(repository, "commit", "-q", "-m", "Adds a project")
    (repository / "stand/motions/wave.yaml").rename(repository / "stand/motions/waving.yaml")
    broken = commit(repository)
    assert broken.returncode == 1
    assert "stand/behaviors/tour.yaml" in broken.stdout


@pytest.mark.slow
def test_pre_commit_lets_no_file_pass_that_belongs_to_no_project(
    repository: Path, commit: Callable[[Path], CompletedProcess[str]]
) -> None:
    (repository / "stand/lumen.yaml").unlink()
    refused = commit(repository)
    assert refused.returncode == 1
    assert "belongs to no project: there is no lumen.yaml in its folder or above" in refused.stdout


STEPS: dict[str, dict[str, Any]] = {step.get("id", step.get("name", "")): step for step in ACTION["runs"]["steps"]}


def perform(step: str, repository: Path, **environment: str) -> tuple[CompletedProcess[str], dict[str, str]]:
    """Run a step of the action in a repository, as GitHub's runner would; return the result and the outputs."""
    runner = repository.parent / "runner"
    runner.mkdir(exist_ok=True)
    outputs = runner / "outputs"
    outputs.write_text("")
    given = {"RUNNER_TEMP": runner, "RUNNER_OS": "Linux", "RUNNER_ARCH": "X64", "GITHUB_OUTPUT": outputs, "LUMEN": ROOT}
    assert STEPS[step]["shell"] == "bash"
    wanted = STEPS[step]["env"].keys() - {"LUMEN"}
    assert wanted == environment.keys()
    script = f"set -e -o pipefail\n{STEPS[step]['run']}"  # as the runner calls bash
    done = shell(script, repository, **environment, **{name: str(value) for name, value in given.items()})
    return done, dict(line.split("=", 1) for line in outputs.read_text().splitlines())


@pytest.fixture
def installed(repository: Path) -> str:
    """An environment that replaces the action's own, with nothing to install."""
    folder = repository.parent / "environment" / "bin"
    folder.mkdir(parents=True)
    (folder / "python").write_text("#!/bin/sh\n[ \"$1 $2 $3\" = '-m pip install' ]\n")
    (folder / "python").chmod(0o755)
    return str(folder.parent)


@pytest.mark.slow
def test_the_action_annotates_at_the_word(repository: Path, installed: str) -> None:
    assert ACTION["runs"]["using"] == "composite"
    inputs = {"PROJECT": "stand", "ARGUMENTS": "--strict", "SARIF": "false", "ENVIRONMENT": installed}
    assert perform("lint", repository, **inputs)[0].returncode == 0
    spoil(repository / "stand")
    done, outputs = perform("lint", repository, **inputs)
    assert done.returncode == 1
    assert outputs == {}
    notes = [line for line in done.stdout.splitlines() if line.startswith("::error ")]
    assert len(notes) == 1
    for part in ("file=stand/behaviors/tour.yaml", "line=28", "col=14", "idel"):
        assert part in notes[0]


@pytest.mark.slow
def test_the_action_hands_its_findings_to_code_scanning_on_wish(repository: Path, installed: str) -> None:
    spoil(repository / "stand")
    inputs = {"PROJECT": "stand", "ARGUMENTS": "", "SARIF": "true", "ENVIRONMENT": installed}
    done, outputs = perform("lint", repository, **inputs)
    assert done.returncode == 1
    [run] = json.loads(Path(outputs["sarif"]).read_text())["runs"]
    assert [result["ruleId"] for result in run["results"]] == ["unknown-state"]
    upload = STEPS["Hand the findings to code scanning"]
    assert upload["with"]["sarif_file"] == "${{ steps.lint.outputs.sarif }}"
    assert upload["if"] == "always() && steps.lint.outputs.sarif != ''"


@pytest.mark.slow
def test_the_action_does_not_pass_where_there_is_no_project(repository: Path, installed: str) -> None:
    inputs = {"PROJECT": ".", "ARGUMENTS": "", "SARIF": "true", "ENVIRONMENT": installed}
    done, outputs = perform("lint", repository, **inputs)
    assert done.returncode != 0
    assert outputs == {}
    assert "pass the folder of one of these projects: `stand`" in done.stderr


def test_the_action_keeps_what_it_installed_until_a_package_changes(repository: Path) -> None:
    core = perform("place", repository, SIMULATION="false", VERSION="3.12.4")[1]
    assert core["group"] == "core"
    assert re.fullmatch(r"lumen-Linux-X64-3\.12\.4-core-[0-9a-f]{20}", core["key"])
    whole = perform("place", repository, SIMULATION="true", VERSION="3.12.4")[1]
    assert whole["group"] == "run"
    assert whole["key"] != core["key"]
    cache = STEPS["cache"]["with"]
    assert cache == {"path": "${{ steps.place.outputs.environment }}", "key": "${{ steps.place.outputs.key }}"}
    assert STEPS["Install the packages of Lumen"]["if"] == "steps.cache.outputs.cache-hit != 'true'"


def test_the_action_leaves_the_job_its_python() -> None:
    assert STEPS["python"]["with"]["update-environment"] is False
    assert not [step for step in STEPS.values() if "GITHUB_PATH" in step.get("run", "")]


@pytest.mark.soak
def test_the_action_installs_what_is_pinned_and_lints_with_it(repository: Path) -> None:
    """From the index that this machine's pip asks: the packages by their hashes, and Lumen of this checkout."""
    place = perform("place", repository, SIMULATION="false", VERSION="3")[1]
    where = {"ENVIRONMENT": place["environment"]}
    needs = {"PYTHON": sys.executable, "GROUP": place["group"]}
    assert perform("Install the packages of Lumen", repository, **where, **needs)[0].returncode == 0
    inputs = {"PROJECT": "stand", "ARGUMENTS": "", "SARIF": "false", **where}
    assert "nothing wrong" in perform("lint", repository, **inputs)[0].stdout
    assert (Path(place["environment"]) / "bin" / "lumen").is_file()


def test_the_action_takes_nothing_from_outside_into_its_commands() -> None:
    """An input's value reaches the shell as a variable only: `${{ … }}` in a command would be run."""
    assert not [step for step in ACTION["runs"]["steps"] if "${{" in step.get("run", "")]
