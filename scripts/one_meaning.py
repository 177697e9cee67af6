"""Find names with two meanings: definitions of a word outside the code that has its one meaning, and metaphors."""

import ast
from collections.abc import Iterator, Mapping, Sequence
from pathlib import PurePosixPath
from typing import NamedTuple

from scopes import Place
from source_files import SourceFile


class Meaning(NamedTuple):
    """The meaning of a word as the name of something defined, and the files and folders that may define it."""

    text: str
    homes: tuple[str, ...] = ()


MEANINGS: Mapping[str, Meaning] = {
    "ask": Meaning(
        "the robot asks a visitor, or a visitor the robot: elsewhere use `request`",
        ("language/", "project/actions.py", "statechart/asking.py", "run/questions.py", "features/console/day.py"),
    ),
    "home_of": Meaning("the folder in which an exhibition keeps its files", ("project/home.py",)),
    "passage": Meaning(
        "a question and its answer in `knowledge/`; a motion in the folder `models/passages`",
        (
            "language/",
            "retrieval/",
            "motion/postures.py",
            *(f"features/console/{file}.py" for file in ("past", "written_sentences")),
            "features/simulation/",
        ),
    ),
    "recording": Meaning(
        "a file with the messages of a run; the robot of `--robot recording`",
        ("language/", "features/mcap/", "robot/recording.py"),
    ),
    "rest": Meaning(
        "the command `rest`: the robot takes its resting posture",
        (
            "language/",
            "robot/command_table.py",
            "run/parts/",
            "features/console/orders.py",
            "features/ears/ears.py",
            *(f"features/{robot}/skills.py" for robot in ("naoqi", "reachy", "simulation")),
        ),
    ),
    "snapshotstore": Meaning("the snapshots and files that a run keeps", ("run/snapshot_store.py",)),
}
"""Words with one allowed meaning, in lower case and without underscores around them."""
IMAGES: Mapping[str, str] = {
    "_came": "_received",
    "_heed": "_on_interrupt, _on_listening",
    "comeback": "resumption",
    "doings": "activity_tracker",
    "tells": "reports",
}
"""Words of another field, each with the proper term."""


def names_of_two_meanings(files: Sequence[SourceFile]) -> Iterator[Place]:
    """Yield the definitions of a word outside its homes, and those of a metaphor.

    Modules, classes, functions, attributes of objects, fields and constants count; local names do not.
    """
    for file in files:
        for name, line in _defined(file):
            word = name.strip("_").lower()
            if term := IMAGES.get(name) or IMAGES.get(word):
                yield Place(file.path, line, f"`{name}` is an image: use `{term}`")
            elif (meaning := MEANINGS.get(word)) and not file.path.startswith(meaning.homes):
                yield Place(file.path, line, f"`{name}` means something else here than elsewhere: {meaning.text}")


def _defined(file: SourceFile) -> Iterator[tuple[str, int]]:
    """Yield the names that a file defines for others, each with its line."""
    yield PurePosixPath(file.path).stem, 1
    yield from _assigned(file.tree.body)
    for kind in file.of(ast.ClassDef):
        yield kind.name, kind.lineno
        yield from _assigned(kind.body)
    for function in (*file.of(ast.FunctionDef), *file.of(ast.AsyncFunctionDef)):
        yield function.name, function.lineno
    for attribute in file.of(ast.Attribute):
        if isinstance(attribute.ctx, ast.Store):
            yield attribute.attr, attribute.lineno


def _assigned(body: Sequence[ast.stmt]) -> Iterator[tuple[str, int]]:
    for node in body:
        targets = (
            node.targets if isinstance(node, ast.Assign) else [node.target] if isinstance(node, ast.AnnAssign) else []
        )
        yield from ((target.id, node.lineno) for target in targets if isinstance(target, ast.Name))
