"""A stranger's part takes part in an exhibition; a faulty one is a finding, and the exhibition runs without it."""

import logging
import shutil
from pathlib import Path

import pytest

import lumen
from lumen.errors import UsageError
from lumen.loading.files import read_files
from lumen.rules import check_files
from tests import ROOT
from tests.stranger.installing import Installed
from tests.tables import for_each

MANIFEST = """
from lumen.feature import Feature, PartRow, Phase

FEATURE = Feature(name="counter", parts=(PartRow("counter", Phase.WATCH, "counting_part:make"),))
"""
COUNTER = """
from lumen.app.parts.part import Part
from lumen.errors import UsageError
from lumen.runtime.loop import Observer

class Counter(Part, Observer):
    watches = True
    steps = 0

    def stepped(self, step):
        self.steps += 1

def make(services):
    {make}
"""
FAULTY = "the installed package `lumen-counter` 1.0 is faulty: its module `counting_part:make` raised "


@pytest.fixture
def minimal(tmp_path: Path) -> Path:
    return shutil.copytree(ROOT / "examples/minimal", tmp_path / "minimal")


def write(installed: Installed, make: str, manifest: str = MANIFEST) -> None:
    installed.write("lumen-counter", manifest, counting_part=COUNTER.format(make=make))


def findings(root: Path) -> list[str]:
    return [each.message for each in check_files(root, read_files(root))[1]]


def test_a_part_watches_the_steps_of_the_behaviour(installed: Installed, minimal: Path) -> None:
    write(installed, "return Counter()")
    assert findings(minimal) == []
    with lumen.open(minimal, robot="recording") as exhibition:
        exhibition.run(seconds=1)
        [counter] = [part for part in exhibition.node.parts if type(part).__name__ == "Counter"]
        assert counter.steps > 0


@for_each(
    ("make", "told"),
    [
        ("1 / 0", "ZeroDivisionError: division by zero"),
        ("import not_installed", "ModuleNotFoundError: No module named 'not_installed'"),
        ("return 3", "TypeError: Value after * must be an iterable, not int"),
        (
            "return type('Deaf', (Part,), {'watches': True})()",
            "TypeError: the part Deaf watches the behaviour: derive it from Observer, too",
        ),
    ],
)
def test_an_exhibition_runs_without_a_part_that_cannot_be_made(
    make: str, told: str, installed: Installed, minimal: Path, caplog: pytest.LogCaptureFixture
) -> None:
    write(installed, make)
    with caplog.at_level(logging.ERROR), lumen.open(minimal, robot="recording") as exhibition:
        exhibition.run(seconds=1)
        assert exhibition.node.now >= 1
    assert f"the part `counter` is left out: {FAULTY}{told}" in caplog.text


def test_a_package_refuses_the_start_with_an_error_of_lumen(installed: Installed, minimal: Path) -> None:
    write(installed, "raise UsageError('the bottle is empty')")
    with pytest.raises(UsageError, match="the bottle is empty"):
        lumen.open(minimal, robot="recording")


@for_each(
    ("old", "new", "told"),
    [
        ("counting_part:make", "counting_part:gone", "AttributeError: module 'counting_part' has no attribute 'gone'"),
        ("counting_part:make", "gone:make", "ModuleNotFoundError: No module named 'gone'"),
        ('make"', 'make", "brian"', "the part `counter` has the unknown condition `brian`: use whole"),
    ],
)
def test_lint_reports_a_row_that_cannot_be_used(
    old: str, new: str, told: str, installed: Installed, minimal: Path
) -> None:
    write(installed, "return None", MANIFEST.replace(old, new))
    [message] = findings(minimal)
    assert message.startswith("the installed package `lumen-counter` 1.0 is faulty: ")
    assert told in message
