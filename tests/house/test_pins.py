"""What is installed or called from elsewhere is named by its contents: packages by hashes, actions by commits."""

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
REQUIREMENTS = (
    "requirements-core.txt",
    "requirements.txt",
    "requirements-no-deps.txt",
    "requirements-test.txt",
    "requirements-docs.txt",
)


def requirements(name: str) -> Iterator[tuple[str, str, int]]:
    """Name, version and number of hashes of each requirement in a file."""
    text = re.sub(r"(?m)^(#|-r requirements-core.txt).*\n", "", (ROOT / name).read_text())
    for row in text.replace("\\\n", " ").splitlines():
        found = re.match(r"([A-Za-z0-9._-]+)==([^ ;]+)", row)
        assert found, f"{name}: `{row[:60]}` is pinned by no version"
        yield found[1], found[2], len(re.findall(r"--hash=sha256:[0-9a-f]{64}\b", row))


def requirements_of(name: str) -> set[tuple[str, str]]:
    return {(package, version) for package, version, _ in requirements(name)}


def test_the_core_holds_no_simulation_and_no_film() -> None:
    core = {name for name, _ in requirements_of("requirements-core.txt")}
    whole = {name for name, _ in requirements_of("requirements.txt")}
    assert core & {"mujoco", "dm-control", "scipy", "pillow", "imageio-ffmpeg", "matplotlib", "labmaze"} == set()
    assert whole >= {"mujoco", "dm-control", "pillow", "imageio-ffmpeg", "matplotlib"}


@pytest.mark.parametrize("name", REQUIREMENTS)
def test_every_package_is_pinned_by_the_hashes_of_its_files(name: str) -> None:
    assert [package for package, _, hashes in requirements(name) if not hashes] == []


def test_no_package_is_pinned_to_two_versions_nor_any_index_named() -> None:
    packages = {package for name in REQUIREMENTS for package in requirements_of(name)}
    assert len({name for name, _ in packages}) == len(packages)
    assert "//" not in "".join((ROOT / name).read_text() for name in REQUIREMENTS)


def test_what_is_set_up_checks_the_hashes() -> None:
    rows = (ROOT / "Makefile").read_text().replace("\\\n", " ").splitlines()
    commands = [row for row in rows if "pip install" in row]
    assert len(commands) == 5
    assert all("--require-hashes" in row or "--no-deps --no-build-isolation" in row for row in commands)


WORKFLOWS = ["action.yml", ".github/workflows/tests.yml", ".pre-commit-hooks.yaml"]


@pytest.mark.parametrize("page", [*WORKFLOWS, "README.md", *sorted(
    str(page.relative_to(ROOT)) for page in (ROOT / "docs").glob("**/*.md"))])  # fmt: skip
def test_actions_are_named_by_their_commits(page: str) -> None:
    named = re.findall(r"uses: *\S+@(\S+)", (ROOT / page).read_text())
    assert [ref for ref in named if not re.fullmatch(r"[0-9a-f]{40}|COMMIT", ref)] == []
