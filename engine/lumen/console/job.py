"""One job of the console: `python -m lumen.console.job JOB PROJECT [ARGUMENTS]`; the last two as a folder and JSON,
of which the first is a robot of `robots:`, empty where there is one.

Its answer goes to the standard output, as JSON. It may take so much memory, and so much time; the system ends it where
it takes more. `poses` alone goes on until there is nothing more to read.
"""

import json
import os
import signal
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import suppress
from datetime import date
from pathlib import Path
from time import monotonic
from typing import IO, Any

import orjson

from lumen.app.recalling import answer_from_journal
from lumen.app.reload.judging_pipe import MAX_MEMORY
from lumen.app.reload.validation_process import NICENESS, limit_memory, limit_time
from lumen.app.replaying.journals import chosen
from lumen.app.replaying.kept_bundles import KeptBundles
from lumen.app.replaying.other_files import against
from lumen.console.day_csv import day_csv
from lumen.console.job_promises import JOB_TIME, NOTHING, OUT_OF_MEMORY, REFUSED
from lumen.console.kept_days import KeptDays
from lumen.errors import LumenError
from lumen.language.sayings import Saying
from lumen.loading.files import read_files
from lumen.rules import check_files

TOO_LONG_AGO = "too long ago"
REPLAY_TIME = 10.0
"""How long visits are played with the saved files [s]; the others are said to be unknown."""


def day(root: Path, robot: str, wanted: str, form: str, whose: str) -> Iterator[bytes]:
    """A day, for a page or as a `csv`: from this machine's files, or from pages of entries that are read (`told`)."""
    days, chosen_day = KeptDays(root, robot), date.fromisoformat(wanted) if wanted else None
    found = days.told(_lines(), chosen_day) if whose == "told" else days.day(chosen_day)
    if found is None:
        yield NOTHING
    elif form == "csv":
        yield orjson.dumps({"date": found.day.isoformat(), "text": day_csv(found)})
    else:
        yield orjson.dumps(found.to_json())


def why(root: Path, robot: str, question: str, what: str, at: str | None) -> Iterator[bytes]:
    """Why something happened, or did not, from the journal."""
    yield orjson.dumps(answer_from_journal(str(root), question, what, at, TOO_LONG_AGO, robot), default=str)


def replay(root: Path, robot: str) -> Iterator[bytes]:
    """What the files on the disk would have done in the visits that are kept; nothing where that can't be said."""
    project = check_files(root, read_files(root, robot))[0]
    if project is None:
        yield NOTHING
        return
    try:
        entries = chosen(root, None, all=True, robot=project.one_of_several).entries()
        found = against(entries, KeptBundles(root, project.one_of_several), project, deadline=monotonic() + REPLAY_TIME)
        yield orjson.dumps(found.to_json(), default=str)
    except LumenError:
        yield NOTHING


def saying(root: Path, robot: str, behavior: str, state: str, row: str, language: str, text: str) -> Iterator[bytes]:
    """Add a sentence of a visitor to the sayings, with the row that should have taken it."""
    from lumen.app.new_saying import write_saying

    yield orjson.dumps({"file": write_saying(root, Saying(behavior, state, row, language, text), robot).as_posix()})


def shape(root: Path, robot: str) -> Iterator[bytes]:
    """What the robot's links look like, and its stage."""
    from lumen.console.drawing import Drawing

    yield orjson.dumps(Drawing(root, robot).shape())


def poses(root: Path, robot: str) -> Iterator[bytes]:
    """Where its links are, a line for each line with joint angles; `null` for what can't be a robot's."""
    from lumen.console.drawing import Drawing

    drawing = Drawing(root, robot)
    limit_time(0.0)
    for line in _lines():
        yield orjson.dumps(drawing.pose(line)) + b"\n"


JOBS: dict[str, Callable[..., Iterable[bytes]]] = {
    "day": day, "why": why, "replay": replay, "saying": saying, "shape": shape, "poses": poses
}  # fmt: skip


def _lines() -> Iterator[Any]:
    for line in sys.stdin.buffer:
        with suppress(ValueError):
            yield orjson.loads(line)


def main(name: str, root: str, arguments: str) -> int:
    """Do a job; 0 where it has answered. What anybody prints goes to the terminal."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C is for the console, which ends us
    if hasattr(os, "nice"):
        os.setpriority(os.PRIO_PROCESS, 0, NICENESS)
    limit_memory(MAX_MEMORY)
    limit_time(JOB_TIME)
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)
    with suppress(BrokenPipeError):
        return _do(answers, JOBS[name](Path(root), *json.loads(arguments)))
    return 0


def _do(answers: IO[bytes], job: Iterable[bytes]) -> int:
    try:
        for part in job:
            answers.write(part)
            answers.flush()
    except LumenError as error:
        answers.write(str(error).encode())
        answers.flush()
        return REFUSED
    except MemoryError:
        return OUT_OF_MEMORY
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
