"""Fetch the missing folders of scripts/fetched.txt: `python scripts/fetch.py [FOLDER …]`. Needs npm.

A second call in another terminal or another worker of pytest waits until the first is done.
"""

import fcntl
import hashlib
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).parents[1]
CACHE = ROOT / ".cache"
MISSING = CACHE / "debian.missing"
"""The packages that scripts/packages.sh could not provide: a line for each, with the reason."""


SIZE = "about 22 MB"
"""The size of all archives together."""


class Package(NamedTuple):
    """A row of the table; `sum` is the SHA-256 of its archive."""

    folder: str
    name: str
    version: str
    sum: str

    @property
    def stamp(self) -> Path:
        """Return the file that exists once the package has been fetched."""
        return ROOT / self.folder / self.version


def main() -> str | None:
    """Fetch the missing packages; return the reason if that is impossible."""
    wanted = tuple(sys.argv[1:]) or (".cache/",)
    rows = [line.split() for line in (ROOT / "scripts/fetched.txt").read_text().splitlines()]
    packages = [Package(*row) for row in rows if row and row[0].startswith(wanted)]
    missing = MISSING.read_text().splitlines() if MISSING.exists() else []
    if not sys.argv[1:] and not shutil.which("npm") and any(line.startswith("npm ") for line in missing):
        return None  # scripts/packages.sh has reported that, and the tests that need it are left out
    if all(package.stamp.exists() for package in packages):
        return None
    CACHE.mkdir(exist_ok=True)
    with (CACHE / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        return fetch([package for package in packages if not package.stamp.exists()])


def fetch(packages: list[Package]) -> str | None:
    """Download the archives with npm, and unpack them; return the reason if that fails."""
    if not packages:
        return None
    if not shutil.which("npm"):
        return "npm is not installed, with which the tests fetch what they ask others with: `make setup` installs it"
    print(f"fetching {len(packages)} packages of npm into .cache, {SIZE}, for the tests (once) …", flush=True)
    with tempfile.TemporaryDirectory(dir=CACHE) as folder:
        names = [f"{package.name}@{package.version}" for package in packages]
        command = ["npm", "pack", "--silent", "--cache", str(CACHE / "npm"), *names]
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
        if done.returncode:
            said = "\n".join((done.stderr or done.stdout).strip().splitlines()[-5:])
            return f"npm could not download {', '.join(names)}: is there a network?\n{said}"
        archives = {hashlib.sha256(archive.read_bytes()).hexdigest(): archive for archive in Path(folder).iterdir()}
        for package in packages:
            if package.sum not in archives:
                return f"{package.name} {package.version} is not the archive that scripts/fetched.txt names"
            unpack(archives[package.sum], package)
    return None


def unpack(archive: Path, package: Package) -> None:
    """Move the content of the archive's only folder to the package's place."""
    unpacked = archive.with_suffix("")
    shutil.unpack_archive(archive, unpacked)
    (content,) = unpacked.iterdir()
    (content / package.version).touch()
    target = ROOT / package.folder
    shutil.rmtree(target, ignore_errors=True)
    target.parent.mkdir(parents=True, exist_ok=True)
    content.rename(target)


if __name__ == "__main__":
    sys.exit(main())
