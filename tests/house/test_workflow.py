"""The workflow for forges runs commands that exist, and each test of `make test-all` in one job."""

import ast
import re
import shlex
import tomllib
from collections.abc import Iterator
from itertools import product
from typing import Any

import yaml

from tests import ROOT

WORKFLOW: dict[str, Any] = yaml.safe_load((ROOT / ".github/workflows/tests.yml").read_text("utf-8"))
JOBS: dict[str, dict[str, Any]] = WORKFLOW["jobs"]
PROJECT: dict[str, Any] = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))
MAKEFILE = (ROOT / "Makefile").read_text("utf-8")
MARKS = {line.partition(":")[0] for line in PROJECT["tool"]["pytest"]["ini_options"]["markers"]}


def commands(job: str) -> Iterator[list[str]]:
    """Yield the words of each command of a job."""
    for step in JOBS[job]["steps"]:
        for line in step.get("run", "").splitlines():
            yield shlex.split(line)


def of_make(job: str) -> Iterator[str]:
    """Yield the words that a job passes to make."""
    for words in commands(job):
        if "make" in words:
            yield from words[words.index("make") + 1 :]


def marks(expression: str) -> set[str]:
    """Return the marks that an expression of pytest's `-m` names."""
    return {node.id for node in ast.walk(ast.parse(expression, mode="eval")) if isinstance(node, ast.Name)}


def test_each_job_is_there_and_runs_on_every_python_that_the_package_names() -> None:
    assert list(JOBS) == ["check", "test", "broker", "browser", "physics", "processes", "wheel"]
    named = re.findall(r"Python :: (3\.\d+)", "\n".join(PROJECT["project"]["classifiers"]))
    assert len(named) == 3
    for job in JOBS.values():
        assert job["strategy"]["matrix"] == {"python": named}
        (python,) = (step["with"] for step in job["steps"] if "setup-python" in step.get("uses", ""))
        assert python["python-version"] == "${{ matrix.python }}"
        assert list(ROOT.glob(python["cache-dependency-path"]))


def test_make_has_the_targets_and_variables_that_jobs_name() -> None:
    words = [word for job in JOBS for word in of_make(job)]
    targets = {word for word in words if "=" not in word}
    assert targets == {"check", "packages", "setup", "tested", "rest"}
    assert targets <= set(re.findall(r"(?m)^([\w-]+):", MAKEFILE))
    variables = {word.partition("=")[0] for word in words if "=" in word}
    assert variables == {"ONLY"}
    assert all(re.search(rf"(?m)^{variable} \?=", MAKEFILE) for variable in variables)
    assert re.search(r"(?m)^rest: setup\n\t.*-m [^\n]*and \(\$\(ONLY\)\)", MAKEFILE)


def test_each_test_of_the_rest_runs_in_one_job() -> None:
    """One of the jobs selects each test, with any marks."""
    selections = [word.removeprefix("ONLY=") for job in JOBS for word in of_make(job) if word.startswith("ONLY=")]
    named = sorted(set().union(*map(marks, selections)))
    assert named == ["broker", "browser", "physics"]
    assert set(named) <= MARKS
    for values in product([False, True], repeat=len(named)):
        given = dict(zip(named, values, strict=True))
        assert [eval(selection, {}, given) for selection in selections].count(True) == 1, given


def test_the_wheel_is_used_by_subcommands_and_options_that_exist() -> None:
    programs = [words for words in commands("wheel") if words[0] == "bare/bin/lumen"]
    assert [words[1] for words in programs] == ["new", "lint", "test"]
    for _, subcommand, *words in programs:
        page = (ROOT / f"docs/commands/{subcommand}.md").read_text("utf-8")
        assert not [word for word in words if word.startswith("-") and f"`{word}`" not in page]
    (pinned,) = (words[-1] for words in commands("wheel") if "--require-hashes" in words)
    assert (ROOT / pinned).is_file()


def test_checks_are_run_once() -> None:
    """`make test` is the checks and `tested`; the job `check` has the checks."""
    assert re.search(r"(?m)^test: setup\n\t@.*-j 2 check tested$", MAKEFILE)
    assert "test" not in [word for job in JOBS for word in of_make(job)]
