"""One lock for all packages: what pip reads is written from it, and any reader of PEP 751 selects the same from it."""

from collections.abc import Iterator
from typing import Any

import check
import locks
import pytest
from packaging.pylock import Pylock
from packaging.requirements import Requirement
from packaging.tags import Tag, compatible_tags, cpython_tags

from tests import ROOT

PLATFORMS = ["manylinux_2_28_x86_64", "manylinux_2_17_x86_64", "manylinux2014_x86_64", "manylinux2010_x86_64",
             "manylinux_2_5_x86_64", "manylinux1_x86_64", "linux_x86_64"]  # fmt: skip
FILES = "https://files.pythonhosted.org/packages"


def package(name: str, marker: str, *digits: str) -> dict[str, Any]:
    wheels = [{"url": f"{FILES}/{name}-1-py3-none-any.whl", "hashes": {"sha256": digit * 64}} for digit in digits]
    return {"name": name, "version": "1", "marker": marker, "wheels": wheels}


def export(lock: dict[str, Any], group: str) -> list[str]:
    """Return the lines for pip of a group, without the comment on top."""
    return locks.exports(lock)[ROOT / f"locks/{group}.txt"].splitlines()[1:]


def test_a_file_for_pip_has_what_its_group_adds_to_those_before_it() -> None:
    below = "python_full_version < '3.13'"
    lock = {
        "packages": [
            package("ants", "'core' in dependency_groups", "b", "a"),
            package("bees", f"'run' in dependency_groups and ({below}) or 'test' in dependency_groups", "c"),
            package("wasps", "'docs' in dependency_groups and ((os_name == 'nt' or 'a' in os_name) and os_name)", "d"),
        ]
    }
    assert export(lock, "core") == [
        "ants==1 \\",
        f"    --hash=sha256:{'a' * 64} \\",
        f"    --hash=sha256:{'b' * 64}",
    ]
    assert export(lock, "run") == ["-r core.txt", f"bees==1 ; {below} \\", f"    --hash=sha256:{'c' * 64}"]
    assert export(lock, "test") == ["-r run.txt", "bees==1 \\", f"    --hash=sha256:{'c' * 64}"]
    assert export(lock, "docs")[1] == "wasps==1 ; (os_name == 'nt' or 'a' in os_name) and os_name \\"


def tags(minor: int) -> Iterator[Tag]:
    """Yield the tags of wheels that CPython 3.MINOR installs on Linux."""
    yield from cpython_tags((3, minor), platforms=PLATFORMS)
    yield from compatible_tags((3, minor), interpreter=f"cp3{minor}", platforms=PLATFORMS)


@pytest.mark.parametrize("minor", [11, 12, 13])
def test_pip_and_other_readers_of_the_lock_install_the_same(minor: int) -> None:
    lock = Pylock.from_dict(locks.read())
    here = {"python_version": f"3.{minor}", "python_full_version": f"3.{minor}.0", "sys_platform": "linux"}
    by_pip: set[tuple[str, str]] = set()
    groups: list[str] = []
    for group in locks.GROUPS:
        groups.append(group)
        rows = (line.removesuffix(" \\") for line in export(locks.read(), group) if not line.startswith((" ", "-")))
        requirements = list(map(Requirement, rows))
        there = [one for one in requirements if not one.marker or one.marker.evaluate(here)]
        by_pip |= {(one.name, str(one.specifier).removeprefix("==")) for one in there}
        selected = lock.select(environment=here, tags=list(tags(minor)), dependency_groups=groups)
        assert {(package.name, str(package.version)) for package, _ in selected} == by_pip
    assert len(by_pip) > 140


def test_the_lock_has_no_wheel_that_cpython_cannot_install() -> None:
    urls = [wheel["url"] for package in locks.read()["packages"] for wheel in package.get("wheels", ())]
    assert len(urls) > 1500
    assert not [url for url in urls if "-pp3" in url or "pyodide" in url or url.endswith("cp314t-win_amd64.whl")]


def wrong(problems: Iterator[tuple[str, str]]) -> list[str]:
    return [name for name, problem in problems if problem]


def test_a_file_for_pip_that_was_changed_by_hand_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(locks, "exports", lambda lock: {ROOT / "locks/core.txt": "ants==1\n"})
    assert wrong(check.requirements_for_pip_are_written_from_the_lock()) == ["locks/core.txt"]


def test_a_requirement_that_the_lock_does_not_meet_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = {"core": ["numpy>=99", "PyYAML>=6", "mujoco"], "run": ["mujoco", "ants"]}
    monkeypatch.setattr(locks, "required", lambda: asked)
    assert wrong(check.the_lock_meets_what_pyproject_requires()) == ["core: numpy>=99", "core: mujoco", "run: ants"]


def test_a_file_of_another_index_is_found(monkeypatch: pytest.MonkeyPatch) -> None:
    ours, other = package("ants", "", "a"), package("bees", "", "b")
    other["wheels"][0]["url"] = "https://mirror.example.org/bees-1-py3-none-any.whl"
    monkeypatch.setattr(locks, "read", lambda: {"packages": [ours, other]})
    assert wrong(check.the_lock_names_files_of_the_package_index_only()) == ["bees"]
