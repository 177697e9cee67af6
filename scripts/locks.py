"""Write the lock, locks/pylock.toml, and the requirements that pip reads, locks/*.txt.

    python -m pip install uv && python scripts/locks.py [PACKAGE …]

The lock has the form of PEP 751. uv resolves pyproject.toml for every Python that it allows, on all platforms. Versions
stay unless pyproject.toml no longer allows them; each PACKAGE gets its newest. The lock has the address and the hash of
each file that CPython can install.
"""

import re
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any, NamedTuple

from packaging.tags import Tag
from packaging.utils import parse_wheel_filename

ROOT = Path(__file__).parents[1]
LOCK = ROOT / "locks/pylock.toml"
PYTHON = "3.11"
"""The oldest Python that Lumen supports."""


class Group(NamedTuple):
    """A dependency group of the lock: the extras and the groups of pyproject.toml that it adds to those before it."""

    purpose: str
    extras: tuple[str, ...]
    groups: tuple[str, ...]


GROUPS = {
    "core": Group("lint, stories, the editor, the buses and modules, and what builds Lumen", (), ("build",)),
    "run": Group("the engine and the simulated robot", ("simulation", "plot", "recording", "console", "fleet"), ()),
    "test": Group("the tests", ("test", "naoqi", "reachy"), ("test",)),
    "docs": Group("the site of the documentation", (), ("docs",)),
}
"""A group needs all groups before it."""
ON_EVERY_PYTHON = "dm-control"
"""pyproject.toml requires it below 3.13 only, where labmaze has a wheel; without what it requires it runs on all."""

IN_GROUP = r"'(\w+)' in dependency_groups"
CLAUSE = re.compile(rf"{IN_GROUP}(?: and \((.+?)\))?(?= or {IN_GROUP}|$)")
FOREIGN_INTERPRETER = re.compile(r"pp|graalpy")
FREE_THREADED = re.compile(r"cp\d+t")
FOREIGN_PLATFORM = re.compile(r"android|emscripten|ios|pyemscripten|pyodide|wasi")

Pins = dict[str, str]
"""The version of each package."""


class Resolved(NamedTuple):
    """The packages of a group and of those before it: versions, and markers, empty if a package is always installed."""

    versions: Pins
    markers: dict[str, str]


def main(newest: list[str]) -> int:
    """Write the lock and its exports; return 1 if the groups need different versions."""
    kept = {name: version for name, version in pins(read()).items() if name not in newest}
    resolved: dict[str, Resolved] = {}
    for group in reversed(GROUPS):
        resolved[group] = _resolve(group, kept)
        kept = kept | resolved[group].versions
    everything = resolved["docs"].versions
    for group, found in resolved.items():
        if other := sorted(name for name, version in found.versions.items() if everything[name] != version):
            print(
                f"{group} resolves to other versions of {', '.join(other)}: bound them in pyproject.toml",
                file=sys.stderr,
            )
            return 1
    markers = {group: resolved[group].markers for group in GROUPS}
    LOCK.write_text(_lock(_files(everything), markers), "utf-8")
    for path, text in exports(read()).items():
        path.write_text(text, "utf-8")
    return 0


def read() -> dict[str, Any]:
    """Return the lock."""
    return tomllib.loads(LOCK.read_text("utf-8"))


def pins(lock: Mapping[str, Any]) -> Pins:
    """Return the version of each package in a lock."""
    return {package["name"]: package["version"] for package in lock["packages"]}


def required() -> dict[str, list[str]]:
    """Return the requirements of each group in pyproject.toml, without those between Lumen's own extras."""
    whole = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))
    extras, groups = whole["project"]["optional-dependencies"], whole["dependency-groups"]
    lines = {
        name: [line for extra in group.extras for line in extras[extra]]
        + [line for one in group.groups for line in groups[one]]
        for name, group in GROUPS.items()
    }
    lines["core"] += whole["project"]["dependencies"]
    return {name: [line for line in some if not line.startswith("lumen-robot[")] for name, some in lines.items()}


def exports(lock: Mapping[str, Any]) -> dict[Path, str]:
    """Return the text of each requirements file."""
    before = ["", *(f"-r {group}.txt\n" for group in GROUPS)]
    return {
        ROOT / f"locks/{group}.txt": "".join(
            [_head(f"For pip, with --no-deps: {about.purpose}."), first, *_rows(lock, group)]
        )
        for (group, about), first in zip(GROUPS.items(), before, strict=False)
    }


def _head(subject: str) -> str:
    return f"# {subject} scripts/locks.py writes this file.\n"


def _rows(lock: Mapping[str, Any], group: str) -> Iterator[str]:
    """Yield the packages that a group adds to those before it, one per row."""
    for package in lock["packages"]:
        clauses = {clause[1]: clause[2] for clause in CLAUSE.finditer(package["marker"])}
        if group in clauses:
            marker = f" ; {clauses[group]}" if clauses[group] else ""
            files = [package["sdist"]] if "sdist" in package else []
            hashes = sorted(file["hashes"]["sha256"] for file in files + package.get("wheels", []))
            lines = [f"{package['name']}=={package['version']}{marker}", *(f"--hash=sha256:{one}" for one in hashes)]
            yield " \\\n    ".join(lines) + "\n"


def _resolve(group: str, kept: Pins) -> Resolved:
    """Resolve a group with those before it, in the kept versions if they can be."""
    text = _uv("requirements.txt", group, kept)
    rows = re.findall(r"(?m)^([\w.-]+)==(\S+)(?: ; (.+))?$", text)
    markers = {name: marker for name, _, marker in rows if name != ON_EVERY_PYTHON}
    if any(name == ON_EVERY_PYTHON for name, _, _ in rows):
        markers[ON_EVERY_PYTHON] = ""
    return Resolved({name: version for name, version, _ in rows}, markers)


def _files(everything: Pins) -> list[dict[str, Any]]:
    """Return each package with its files."""
    packages = tomllib.loads(_uv("pylock.toml", "docs", everything, "--constraints"))["packages"]
    assert pins({"packages": packages}) == everything
    return list(packages)


def _uv(form: str, group: str, versions: Pins, *bound: str) -> str:
    """Return uv's output in this form for a group and those before it."""
    names = list(GROUPS)[: list(GROUPS).index(group) + 1]
    wanted = [f"--extra={extra}" for name in names for extra in GROUPS[name].extras]
    wanted += [f"--group={one}" for name in names for one in GROUPS[name].groups]
    with tempfile.TemporaryDirectory() as folder:
        pinned, output = Path(folder, "requirements.txt"), Path(folder, form)  # uv prefers the versions in its output
        pinned.write_text("".join(f"{name}=={version}\n" for name, version in versions.items()), "utf-8")
        options = [*wanted, *(f"{option}={pinned}" for option in bound), f"--format={form}", f"--output-file={output}"]
        options += ["--universal", f"--python-version={PYTHON}", "--no-header", "--no-annotate", "--quiet"]
        command = [sys.executable, "-m", "uv", "pip", "compile", "pyproject.toml", *options]
        subprocess.run(command, cwd=ROOT, stdout=subprocess.DEVNULL, check=True)
        return output.read_text("utf-8")


def _lock(packages: list[dict[str, Any]], markers: Mapping[str, Mapping[str, str]]) -> str:
    groups = ", ".join(f'"{group}"' for group in GROUPS)
    head = [
        'lock-version = "1.0"',
        'created-by = "scripts/locks.py"',
        f'requires-python = ">={PYTHON}"',
        f"dependency-groups = [{groups}]",
        'default-groups = ["core"]',
    ]
    tables = [_package(package, _marker(package["name"], markers)) for package in packages]
    return "\n".join([_head("Every package that Lumen installs, as PEP 751 has it.") + "\n".join(head) + "\n", *tables])


def _package(package: Mapping[str, Any], marker: str) -> str:
    lines = ["[[packages]]", f'name = "{package["name"]}"', f'version = "{package["version"]}"', f'marker = "{marker}"']
    if "sdist" in package:
        lines.append(f"sdist = {_file(package['sdist'])}")
    if wheels := [f"    {_file(file)},\n" for file in package.get("wheels", ()) if _is_installable(file["url"])]:
        lines.append(f"wheels = [\n{''.join(wheels)}]")
    return "\n".join(lines) + "\n"


def _marker(name: str, markers: Mapping[str, Mapping[str, str]]) -> str:
    """Return the marker of a package: a clause for each group that adds something to the groups before it."""
    clauses, before = [], None
    for group, found in markers.items():
        marker = found.get(name, before)
        if marker is not None and marker != before:
            clauses.append(f"'{group}' in dependency_groups" + (f" and ({marker})" if marker else ""))
        before = marker
    return " or ".join(clauses)


def _file(file: Mapping[str, Any]) -> str:
    return f'{{ url = "{file["url"]}", hashes = {{ sha256 = "{file["hashes"]["sha256"]}" }} }}'


def _is_installable(url: str) -> bool:
    """Return True if CPython on a computer can install this wheel."""
    return any(map(_is_cpython, parse_wheel_filename(url.rpartition("/")[2])[-1]))


def _is_cpython(tag: Tag) -> bool:
    foreign = FOREIGN_INTERPRETER.match(tag.interpreter) or FOREIGN_PLATFORM.match(tag.platform)
    return not foreign and not FREE_THREADED.fullmatch(tag.abi)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
