"""A child that imports hostile files: it reads an attack's number from standard input, and prints a line of JSON.

A file that takes longer than `LIMIT` ends the child by an alarm; its parent notices this as it notices a crash.
"""

import io
import json
import os
import signal
import sys
from contextlib import redirect_stderr, redirect_stdout
from functools import cache
from pathlib import Path
from typing import Any

import lumen
from lumen.cli.main import main
from lumen.upkeep.heap import give_back
from tests.attack.attacks import attack
from tests.attack.files import foreign_file

LIMIT = 20
"""The time limit for the import of one file [s]; most need a few milliseconds."""


def imported(folder: Path, number: int) -> dict[str, Any]:
    """Import the file of that attack; return the exit code, the fault that no file may cause, if any, and the size."""
    name, content = foreign_file(attack(number).random)
    (folder / name).write_bytes(content)
    told = io.StringIO()
    signal.alarm(LIMIT)
    try:
        with redirect_stderr(told), redirect_stdout(io.StringIO()):
            code = main(["import", str(folder / name), "-o", str(folder / "out.yaml")])
        trouble = _trouble(code, told.getvalue())
    except BaseException as error:  # a traceback, for who types it
        code, trouble = -1, f"{name}: {error!r}"
    finally:
        signal.alarm(0)
    return {"code": code, "trouble": trouble, "size": _size()}


def _trouble(code: int, told: str) -> str:
    right = "Traceback" not in told and (code in (0, 1) or (code == 2 and told.count("\n") == 1))
    return "" if right else f"it ended with {code} and said: {told[:500]}"


def _size() -> tuple[float, int, int]:
    status = Path("/proc/self/status").read_text()
    fields = dict(line.split(":\t", 1) for line in status.splitlines() if ":\t" in line)
    return int(fields["VmRSS"].split()[0]) / 1024, int(fields["Threads"]), len(os.listdir("/proc/self/fd"))


if __name__ == "__main__":
    give_back()  # what grows is what is kept, not what the C library holds between thousands of files
    lumen.load = cache(lumen.load)  # the robot whose joints a motion moves is the same each time
    for line in sys.stdin:
        sys.stdout.write(json.dumps(imported(Path(sys.argv[1]), int(line))) + "\n")
        sys.stdout.flush()
