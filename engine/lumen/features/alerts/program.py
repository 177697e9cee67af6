"""Alerts as the standard input of a program."""

import json
import os
import signal
import subprocess
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

from lumen.errors import UndeliveredError

PROGRAM_TIMEOUT = 30.0
"""The time that the program may take [s]; then it is killed, with all processes that it has started."""


def run_program(command: Sequence[str], body: dict[str, Any], root: Path) -> None:
    """Run the program in the project's folder and wait for its end.

    Raises UndeliveredError unless its exit code is 0.
    """
    name = command[0]
    if os.path.basename(name) != name:
        name = str(root / name)
    try:
        process = subprocess.Popen(
            [name, *command[1:]],
            cwd=root,
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            start_new_session=True,
        )
    except (OSError, ValueError) as error:
        raise UndeliveredError(
            f"the program can't be run: {getattr(error, 'strerror', None) or error}", final=True
        ) from None
    try:
        _, said = process.communicate(json.dumps(body).encode(), PROGRAM_TIMEOUT)
    except subprocess.TimeoutExpired:
        raise UndeliveredError(f"the program did not end within {PROGRAM_TIMEOUT:g} s") from None
    finally:
        _end(process)
    if process.returncode:
        last = said.decode("utf-8", "replace").strip().splitlines()[-1:]
        raise UndeliveredError(
            f"the program ended with exit code {process.returncode}{': ' * bool(last)}{''.join(last)[:200]}"
        )


def _end(process: "subprocess.Popen[bytes]") -> None:
    """Kill the program and all processes that it has started."""
    if process.poll() is None or hasattr(os, "killpg"):
        with suppress(OSError):
            os.killpg(process.pid, signal.SIGKILL) if hasattr(os, "killpg") else process.kill()
    process.wait()
    for pipe in (process.stdin, process.stderr):
        if pipe:
            with suppress(OSError):
                pipe.close()
