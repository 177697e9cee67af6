"""`lumen` called in this process, the same whatever terminal, time zone, language or home the caller has."""

import io
import logging
import os
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

from tests import ROOT
from tests.golden.adapters_language import lumen_main

COLUMNS = 100
CHECKOUT = ROOT


class Outcome(NamedTuple):
    """The outcome of a call of `lumen`; paths begin with FOLDER, or CHECKOUT for files that come with Lumen."""

    code: int
    out: str
    err: str

    def __str__(self) -> str:
        parts = [f"exit {self.code}\n"]
        parts += [f"--- {name}\n{text}" for name, text in (("out", self.out), ("err", self.err)) if text]
        return "".join(part if part.endswith("\n") else f"{part}\\\n" for part in parts)


@contextmanager
def workplace() -> Iterator[Path]:
    """Yield an empty folder to call `lumen` in, below no project; what calls keep at home goes with it."""
    with tempfile.TemporaryDirectory(prefix="lumen-golden-") as place:
        folder = Path(place).resolve() / "folder"
        folder.mkdir()
        yield folder


def environment(home: Path) -> dict[str, str]:
    """Return all variables that a call has: none of the caller's but PATH."""
    return {
        "PATH": os.environ.get("PATH", os.defpath),
        "HOME": str(home),
        "XDG_CACHE_HOME": str(home / "cache"),
        "XDG_RUNTIME_DIR": str(home),
        "COLUMNS": str(COLUMNS),
        "LINES": "40",
        "TERM": "dumb",
        "GIT_CEILING_DIRECTORIES": str(home.parent),
        "TZ": "UTC",
        "LANG": "C.UTF-8",
        "LC_ALL": "C.UTF-8",
    }


def lumen(folder: Path, *words: str, base: Path | None = None, typed: str = "") -> Outcome:
    """Call `lumen` with these words in `folder`; `base` (default: the folder) is printed as FOLDER."""
    base = base or folder
    with _apart(folder, base, typed) as (out, err):
        try:
            code = lumen_main(words)
        except SystemExit as ended:
            code = ended.code if isinstance(ended.code, int) else int(bool(ended.code))
    texts = [_text(stream).replace(str(base), "FOLDER").replace(str(CHECKOUT), "CHECKOUT") for stream in (out, err)]
    return Outcome(code, *texts)


def _text(stream: io.TextIOWrapper) -> str:
    stream.flush()
    buffer = stream.buffer
    assert isinstance(buffer, io.BytesIO)
    return buffer.getvalue().decode()


@contextmanager
def _apart(folder: Path, base: Path, typed: str) -> Iterator[tuple[io.TextIOWrapper, io.TextIOWrapper]]:
    """Change folder, variables, streams and log handlers for one call, and restore them."""
    home = base.parent / "home"
    home.mkdir(exist_ok=True)
    kept = Path.cwd(), dict(os.environ), (sys.stdin, sys.stdout, sys.stderr), list(logging.root.handlers)
    sys.stdin = io.TextIOWrapper(io.BytesIO(typed.encode()), "utf-8")
    sys.stdout, sys.stderr = out, err = [io.TextIOWrapper(io.BytesIO(), "utf-8") for _ in range(2)]
    try:
        logging.root.handlers[:] = []
        os.chdir(folder)
        _become(environment(home))
        yield out, err
    finally:
        os.chdir(kept[0])
        _become(kept[1])
        sys.stdin, sys.stdout, sys.stderr = kept[2]
        logging.root.handlers[:] = kept[3]


def _become(variables: dict[str, str]) -> None:
    os.environ.clear()
    os.environ.update(variables)
    time.tzset()
