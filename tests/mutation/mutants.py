"""Mutants of the shipped project, each from a number: the same number makes the same mutant."""

from collections.abc import Iterator, Mapping
from pathlib import Path
from random import Random
from typing import NamedTuple

from lumen.project.files import read_files
from tests import ROOT
from tests.mutation.operators import OPERATORS
from tests.mutation.text import Sheet

SHIPPED = read_files(ROOT)
WEIGHTS = {"behaviors/tour.yaml": 30, "lumen.yaml": 12, "fuzzy/head.yaml": 8, "models/nao.yaml": 6}
"""The number of times to change a file; others are changed once, a motion and a story three times."""

OF_OTHER_BODIES = tuple(
    f"{folder}{name}" for folder in ("motions/", "models/") for name in ("greeter", "lantern", "sprout")
)
"""The beginnings of the names of files that are not read if NAO is the robot."""

IN_TWO_PLACES = ("swap values", "swap lines", "move a key", "exchange files")
"""Kinds of change after which two places are wrong, and two findings right."""


class Mutant(NamedTuple):
    """`file` is the changed file, `line` the first changed line, `files` the whole project; `kind` names the mistake.

    `mistakes` counts the places that were changed: two whose values, lines or files were exchanged are two.
    """

    number: int
    kind: str
    file: str
    line: int
    files: Mapping[str, bytes]
    mistakes: int = 1

    @property
    def difference(self) -> str:
        """The lines that went and came."""
        old = SHIPPED.get(self.file, b"").decode("utf-8", "replace").splitlines()
        new = self.files.get(self.file, b"").decode("utf-8", "replace").splitlines()
        while old and new and old[-1] == new[-1]:
            old.pop(), new.pop()
        at = self.line - 1
        shown = [f"-{line}" for line in old[at : at + 4]] + [f"+{line}" for line in new[at : at + 4]]
        return "\n".join([f"{self.file}:{self.line}", *shown])


class Nursery:
    """Makes mutants; the places in the shipped files are looked up once."""

    def __init__(self) -> None:
        self.sheets = {file: Sheet(file, content) for file, content in SHIPPED.items() if not file.endswith(".xml")}
        self.names = [file for file in SHIPPED if not file.startswith(OF_OTHER_BODIES)]
        self.weights = [WEIGHTS.get(f, 3 if f.startswith(("motions/", "behaviors/")) else 1) for f in self.names]

    def mutant(self, number: int) -> Mutant:
        """Return the mutant of that number; one in ten has two mistakes in the same file."""
        random = Random(number)
        file = random.choices(self.names, self.weights)[0]
        if file.endswith(".xml") or random.random() < 0.02:
            return self._whole(random, number, file)
        kinds, content = [], SHIPPED[file]
        for _ in range(2 if random.random() < 0.1 else 1):
            kind = random.choice(list(OPERATORS))
            sheet = self.sheets[file] if not kinds else _sheet(file, content)
            if sheet is None:
                break
            kinds.append(kind)
            content = OPERATORS[kind](random, sheet, self.sheets).encode("utf-8", "surrogateescape")
        mistakes = sum(1 + (kind in IN_TWO_PLACES) for kind in kinds)
        return Mutant(number, kinds[0], file, _first(SHIPPED[file], content), {**SHIPPED, file: content}, mistakes)

    def mutants(self, seed: int, count: int) -> Iterator[Mutant]:
        """Yield `count` mutants, from number `seed` on."""
        return (self.mutant(number) for number in range(seed, seed + count))

    def _whole(self, random: Random, number: int, file: str) -> Mutant:
        """Delete, rename or empty a file, or exchange its content with another one's."""
        files, kind = dict(SHIPPED), random.choice(["delete a file", "rename a file", "exchange files", "binary file"])
        other = random.choice(self.names)
        match kind:
            case "delete a file":
                del files[file]
            case "rename a file":
                files[str(Path(file).with_stem(Path(file).stem + random.choice(["2", " ", ".x", "-É"])))] = files.pop(
                    file
                )
            case "exchange files":
                files[file], files[other] = files[other], files[file]
            case _:
                files[file] = random.randbytes(random.choice([0, 1, 300]))
        return Mutant(number, kind, file, 1, dict(sorted(files.items())), 1 + (kind in IN_TWO_PLACES))


def _sheet(file: str, content: bytes) -> Sheet | None:
    """Return the mutant as a sheet for another change; None if it is unreadable or too small."""
    try:
        sheet = Sheet(file, content)
    except AssertionError:
        return None
    return sheet if sheet.leaves and sheet.keys else None


def _first(old: bytes, new: bytes) -> int:
    """Return the number of the first line that differs, from 1."""
    pairs = enumerate(zip(old.split(b"\n"), new.split(b"\n"), strict=False), 1)
    return next((i for i, (a, b) in pairs if a != b), 1)
