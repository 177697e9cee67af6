"""A small project with a behaviour or a motion of other content, which tests of files change."""

from pathlib import Path

from lumen.project.files import read_files
from tests import ROOT

MINIMAL = ROOT / "examples/minimal"
TOUR, WAVE = "behaviors/tour.yaml", "motions/wave.yaml"
BASE = {
    "lumen.yaml": read_files(MINIMAL)["lumen.yaml"]
    .replace(b"behavior: hello", b"behavior: tour")
    .replace(b"story: visitor", b"# no story"),
}

STATES = """
states:
  idle:
    on: {touched: greet}
  greet:
    do: {say: Hello}
    onDone: idle
    onError: idle
"""
"""A valid behaviour, which begins with an empty line."""


def project(name: str, content: bytes) -> dict[str, bytes]:
    """Return the files of a small project with that content as its behaviour or motion."""
    sound = {TOUR: STATES.encode()}
    return {**BASE, **sound, (WAVE if name.endswith(".motion.yaml") else TOUR): content}


def changed(old: str, new: str, more: str = "") -> bytes:
    assert STATES.count(old) == 1
    return (STATES.replace(old, new) + more).encode()


def placed(root: Path, files: dict[str, bytes]) -> Path:
    for file, content in files.items():
        path = root / file
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)
    return root


MISSPELT = changed("onError: idle", "onError: idel")
