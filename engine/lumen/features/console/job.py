"""One job of the console: `python -m lumen.features.console.job JOB PROJECT [ARGUMENTS]`.

PROJECT is a folder. ARGUMENTS is a JSON list that begins with a robot of `robots:`, empty if there is only one.

A `JudgeProcess` runs the job, which answers with JSON. The system ends a job that exceeds its memory or time limit.
Only `poses` sends several answers, one for each question. Each job imports its own modules, because imports need most
of the time.
"""

import json
import re
import sys
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import suppress
from datetime import date
from pathlib import Path, PurePosixPath
from time import monotonic
from typing import Any

import orjson

from lumen.errors import LumenError
from lumen.features.console.job_promises import JOB_TIME, MAX_SHOWN, NOTHING
from lumen.upkeep.garbage import search_rarely
from lumen.upkeep.judge_process import MAX_MEMORY, AnswerPipe, answering, limit_time

TOO_LONG_AGO = "too long ago"
_MANIFEST = re.compile(r"skills/[^/]+\.yaml")
REPLAY_TIME = 10.0
"""The time limit for replaying visits with the saved files [s]; visits left over are reported as unknown."""


def day(pipe: AnswerPipe, root: Path, robot: str, wanted: str, form: str, whose: str) -> Iterator[bytes]:
    """Answer with a day for a page, or as CSV if `form` is `csv`.

    The entries come from this machine's files, or from the pipe if `whose` is `told`. An empty `wanted` means the last
    day. The answer is NOTHING if this machine has no files.
    """
    from lumen.features.console.day import day_csv
    from lumen.features.console.kept_days import KeptDays

    days, chosen_day = KeptDays(root, robot), date.fromisoformat(wanted) if wanted else None
    found = days.told(_read(iter(pipe.receive, None)), chosen_day) if whose == "told" else days.day(chosen_day)
    if found is None:
        yield NOTHING
    elif form == "csv":
        yield orjson.dumps({"date": found.day.isoformat(), "text": day_csv(found)})
    else:
        yield orjson.dumps(found.to_json())


def entries(pipe: AnswerPipe, root: Path, robot: str, first: int, last: int) -> Iterator[bytes]:
    """Answer with up to MAX_SHOWN entries between two positions, from this machine's files."""
    from lumen.features.console.kept_days import KeptDays

    yield orjson.dumps(KeptDays(root, robot).entries(first, last, MAX_SHOWN), default=str)


def why(pipe: AnswerPipe, root: Path, robot: str, question: str, what: str, at: str | None) -> Iterator[bytes]:
    """Answer from the journal why something happened, or did not."""
    from lumen.run.recalling import answer_from_journal

    yield orjson.dumps(answer_from_journal(str(root), question, what, at, TOO_LONG_AGO, robot), default=str)


def replay(pipe: AnswerPipe, root: Path, robot: str) -> Iterator[bytes]:
    """Replay the recorded visits with the saved files; answer NOTHING if the files have errors or the replay fails."""
    from lumen.lint import check_files
    from lumen.project.files import read_files
    from lumen.run.replaying.journals import KeptBundles, chosen
    from lumen.run.replaying.other_files import against

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


def saying(
    pipe: AnswerPipe, root: Path, robot: str, behavior: str, state: str, row: str, language: str, text: str
) -> Iterator[bytes]:
    """Add a visitor's sentence to the sayings, with the row that should have matched it; answer with their file."""
    from lumen.language.sayings import Saying
    from lumen.run.new_saying import write_saying

    yield orjson.dumps({"file": write_saying(root, Saying(behavior, state, row, language, text), robot).as_posix()})


def chart(pipe: AnswerPipe, root: Path, robot: str, hash: str) -> Iterator[bytes]:
    """Answer with the running behaviour's chart, as boxes and lines."""
    from lumen.features.console.drawn_chart import chart_of

    yield orjson.dumps(chart_of(root, robot, hash))


def story(pipe: AnswerPipe, root: Path, robot: str, position: int, visitor: str, name: str) -> Iterator[bytes]:
    """Write the story of a visit, in which `visitor` is called `name`; answer with its file and a remark."""
    from lumen.features.console.kept_stories import keep_story

    kept = keep_story(root, position, robot, visitor=visitor, name=name)
    yield orjson.dumps({"file": kept.file.as_posix(), "remark": kept.remark})


def skills(pipe: AnswerPipe, root: Path, robot: str, hash: str) -> Iterator[bytes]:
    """Answer with the project's skills, read from their manifests."""
    yield orjson.dumps(skills_of(root, robot, hash))


def sentence(pipe: AnswerPipe, root: Path, robot: str, said: dict[str, Any], hint: dict[str, Any]) -> Iterator[bytes]:
    """Answer with the places in the saved files from which a sentence of the robot probably comes."""
    from lumen.features.console.written_sentences import SaidSentence, places

    yield orjson.dumps(places(root, robot, SaidSentence(**said, **hint)))


def wording(pipe: AnswerPipe, root: Path, robot: str, wanted: dict[str, Any], write: bool) -> Iterator[bytes]:
    """Check a sentence's new wording, and save it if `write` is true and it has no errors; answer with the findings."""
    from lumen.features.console.rewording import NewWording, reword

    yield orjson.dumps(reword(root, robot, NewWording.read(wanted), write=write))


def shape(pipe: AnswerPipe, root: Path, robot: str) -> Iterator[bytes]:
    """Answer with the shapes of the robot's links, and its stage."""
    from lumen.features.console.drawing import Drawing

    yield orjson.dumps(Drawing(root, robot).shape())


def poses(pipe: AnswerPipe, root: Path, robot: str) -> Iterator[bytes]:
    """Answer each question with the links' poses, or with `null` if it has no valid joint angles."""
    from lumen.features.console.drawing import Drawing

    drawing = Drawing(root, robot)
    limit_time(0.0)
    for angles in _read(pipe):
        yield orjson.dumps(drawing.pose(angles))


def skills_of(root: Path, robot: str, hash: str) -> dict[str, Any]:
    """Return the skills of the bundle `hash`, or of the saved files if that bundle was not kept, sorted by name.

    A manifest's text in several languages is a map from language to text.
    """
    from lumen.project.files import read_files
    from lumen.run.one_robot import one_robot
    from lumen.run.replaying.journals import KeptBundles

    robot = one_robot(root, robot)
    files = KeptBundles(root, robot).files(hash) or read_files(root, robot)
    names = sorted(filter(_MANIFEST.fullmatch, files))
    return {"skills": [one for file in names if (one := _skill(file, files[file]))]}


def _skill(file: str, content: bytes) -> dict[str, Any] | None:
    """Return a skill as JSON data, None if its manifest can't be read."""
    from lumen.project.yaml_reader import parse

    document, _ = parse(file, content)
    data = document.data if document else None
    if not isinstance(data, Mapping):
        return None
    by, schema = data.get("performed-by"), data.get("in")
    schema = schema if isinstance(schema, Mapping) else {}
    kind, target = next(iter(by.items())) if isinstance(by, Mapping) and by else ("", "")
    properties = schema.get("properties")
    return {
        "name": PurePosixPath(file).stem,
        "file": file,
        "description": data.get("description", ""),
        "kind": str(kind),
        "target": " ".join(map(str, target)) if isinstance(target, list) else str(target),
        "arguments": properties if isinstance(properties, Mapping) else {},
        "required": [name for name in schema.get("required") or () if isinstance(name, str)],
    }


JOBS: dict[str, Callable[..., Iterable[bytes]]] = {
    "day": day, "entries": entries, "why": why, "replay": replay, "saying": saying, "story": story, "chart": chart,
    "skills": skills, "sentence": sentence, "wording": wording, "shape": shape, "poses": poses,
}  # fmt: skip


def _read(questions: Iterable[bytes]) -> Iterator[Any]:
    for question in questions:
        with suppress(ValueError):
            yield orjson.loads(question)


def main(name: str, root: str, arguments: str) -> None:
    """Run a job and send its answers, or the LumenError that it raises."""
    search_rarely()
    with answering(MAX_MEMORY) as pipe:
        limit_time(JOB_TIME)
        try:
            for answer in JOBS[name](pipe, Path(root), *json.loads(arguments)):
                pipe.send(answer)
        except LumenError as error:
            pipe.send(LumenError(str(error)))  # not every subclass can be pickled


if __name__ == "__main__":
    main(*sys.argv[1:])
