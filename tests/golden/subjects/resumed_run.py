"""The home of a killed run, resumed by `lumen run` itself 10 s later: transcript, exit code and errors.

Also with files that were changed meanwhile, with files that can't resume it, and with `--fresh`. Time is
virtual, and the date is set.
"""

import json
import os
import re
import sys
from collections.abc import Callable, Iterator
from contextlib import redirect_stderr, redirect_stdout
from io import StringIO
from pathlib import Path
from tempfile import TemporaryDirectory
from unittest.mock import patch

from tests.golden.adapters import main
from tests.golden.subjects.recovered_home import HOME, put
from tests.golden.texts import write

SUITE = "rest"
LATER = 10.0
TOOK = re.compile(r"ready after [0-9.]+ s|in [0-9.]+ s \(.*|[0-9.]+ ms$")
"""Durations on this machine."""


def record(folder: Path) -> None:
    """Write a file for each start."""
    for name, change, options in (
        ("same", lambda text: text, ()),
        ("text", lambda text: text.replace("How are you?", "How do you do?"), ()),
        ("renamed", lambda text: text.replace("how_are_you", "feeling"), ()),
        ("fresh", lambda text: text, ("--fresh",)),
    ):
        with TemporaryDirectory() as temporary:
            root = put(Path(temporary))
            edit(root, change)
            write(folder / f"{name}.txt", started(root, *options))


def edit(root: Path, change: Callable[[str], str]) -> None:
    """Change the behaviour and its stories."""
    for file in sorted((root / "behaviors").rglob("*.yaml")):
        text = file.read_text("utf-8")
        if (new := change(text)) != text:
            file.write_text(new, "utf-8")


def started(root: Path, *options: str) -> Iterator[str]:
    """Yield the output of `lumen run`, without the parts that depend on the machine."""
    now = json.loads((HOME / "alive.json").read_text("utf-8"))["time"] + LATER
    out, errors = StringIO(), StringIO()
    words = ["run", str(root), "--robot", "recording", "--speed", "max", "--for", "45s", "--reload", "off", *options]
    with (
        patch("time.time", lambda: now),
        patch.dict(os.environ, TZ="Etc/UTC", COLUMNS="120"),
        patch.object(sys, "stdin", None),
        redirect_stdout(out),
        redirect_stderr(errors),
    ):
        code = main(words)
    for stream in (out, errors):
        for line in stream.getvalue().splitlines():
            yield TOOK.sub("…", line.replace(str(root), "ROOT").replace(str(root.parent), "FOLDER")).rstrip()
    yield f"exit code {code}"
