"""The processor time that hostile and large files take [s], printed, and bounded for the machines that soak."""

import sys
import time
from collections.abc import Callable
from pathlib import Path
from random import Random

import pytest

from lumen.cli.main import main
from lumen.lint import check_files
from lumen.project.yaml_reader import parse
from tests.attack.files import foreign_file, project_file
from tests.attack.test_files import BASE, NUMBERED, blanks
from tests.features.formats_charts import test_hostile
from tests.formats.test_large import SHAPES, imported
from tests.loading.test_yaml_composer import DEEP

pytestmark = pytest.mark.soak

SMALL, TIMES, SLACK = 400, 5, 2.0
"""A file five times as large may take ten times as long; a quadratic algorithm takes 25 times."""


def seconds(do: Callable[[], object]) -> float:
    began = time.process_time()
    do()
    return time.process_time() - began


def longest(what: str, takes: dict[str, Callable[[], object]], limit: float) -> None:
    found = {name: seconds(do) for name, do in takes.items()}
    name, most = max(found.items(), key=lambda pair: pair[1])
    sys.stdout.write(f"{what}: {most:.2f} s at most, for {name}\n")
    assert most < limit


def test_hostile_files_are_answered_at_once(tmp_path: Path) -> None:
    charts = [(test_hostile.read_scxml, *row) for row in test_hostile.HOSTILE_XML]
    charts += [(test_hostile.read_xstate, *row) for row in test_hostile.HOSTILE_JSON]
    refused = {f"{row[3]} {at}": lambda row=row: test_hostile.refused(*row) for at, row in enumerate(charts)}  # type: ignore[misc]
    longest("charts that are refused", refused, 2.0)
    large = list(test_hostile.large_files())
    assert sum(seconds(lambda read=read, file=file: read("chart", file, "chart")) for read, file in large) < 15.0  # type: ignore[misc]
    deep = {kind: lambda text=text: parse("behaviors/notes.yaml", text.encode()) for kind, text in DEEP.items()}  # type: ignore[misc]
    longest("nested YAML", deep, 1.0)


def test_files_of_other_tools_are_imported_at_once(tmp_path: Path) -> None:
    def importing(name: str, content: bytes) -> Callable[[], object]:
        (tmp_path / name).write_bytes(content)
        return lambda: main(["import", str(tmp_path / name), "-o", str(tmp_path / "out.yaml")])

    files = [
        (f"blank.{ending}", blank) for ending in ("py", "fcl", "fll", "fis", "motion", "scxml") for blank in " \n\t"
    ]
    for name, blank in files:
        longest("hundreds of thousands of blanks", {name: importing(name, blanks(name, blank).encode())}, 2.0)
    longest("long numbers", {name: importing(name, text.encode()) for name, text in NUMBERED.items()}, 2.0)
    foreign = {seed: foreign_file(Random(seed)) for seed in range(120)}
    for seed, (name, content) in foreign.items():
        longest(f"seed {seed}", {name: importing(name, content)}, 5.0)


def test_a_project_with_a_hostile_file_is_judged_at_once() -> None:
    found = {seed: project_file(Random(seed), BASE) for seed in range(160)}
    takes = {
        f"{path} of seed {seed}": lambda path=path, content=content: check_files(  # type: ignore[misc]
            Path("/nowhere"), {**BASE, path: content}
        )
        for seed, (path, content) in found.items()
    }
    longest("projects", takes, 5.0)


@pytest.mark.parametrize("shape", SHAPES)
def test_five_times_as_large_is_not_twenty_five_times_as_slow(shape: str, tmp_path: Path) -> None:
    imported(shape, 10, tmp_path)
    small, large = (seconds(lambda count=count: imported(shape, count, tmp_path)) for count in (SMALL, TIMES * SMALL))  # type: ignore[misc]
    sys.stdout.write(f"{shape}: {small:.2f} s for {SMALL}, {large:.2f} s for {TIMES * SMALL}\n")
    assert large < SLACK * TIMES * small
