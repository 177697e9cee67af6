"""A faulty package breaks neither a command nor other packages: each fault is a sentence that names its package."""

from pathlib import Path

import pytest

from lumen.cli.main import main
from lumen.project.broken_features import shown
from tests import ROOT
from tests.copying import copied_project
from tests.stranger.installing import Installed
from tests.tables import for_each

MANIFEST = "from lumen.feature import *\n\nFEATURE = Feature(name='faulty', {row})\n"
FAULT = "the installed package `faulty` 1.0 is faulty: "
MUTE = "class Odd(Exception):\n    def __str__(self): return None\n    __repr__ = __str__\n"
RUN = ("run", "--robot", "recording", "--speed", "max", "--story", "visitor")


@pytest.fixture
def hall(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    root = copied_project(ROOT / "examples/minimal", tmp_path / "hall")
    monkeypatch.chdir(root)
    return root


@pytest.mark.process
@for_each(
    ("manifest", "code", "words", "fault"),
    [
        (f"{MUTE}raise Odd", "", ["lint"], "its manifest `faulty:FEATURE` raised Odd"),
        (
            MANIFEST.format(row="rules=('faulty_code:check',)"),
            f"{MUTE}def check(draft): raise Odd",
            ["lint"],
            "its rule `faulty_code:check` raised Odd",
        ),
        (
            MANIFEST.format(row="rules=('faulty_code:check',)"),
            f"{MUTE}def check(draft): draft.loose.append(Odd())",
            ["lint"],
            "its rule `faulty_code:check` reported <Odd>, which is no finding",
        ),
        (
            MANIFEST.format(row="parts=(PartRow('odd', Phase.WATCH, 'faulty_code:make'),)"),
            f"from lumen.run.parts.part import Part\n{MUTE}\n"
            "class make(Part):\n    def __init__(self, services): super().__init__()\n"
            "    def tick(self, now, changes): raise Odd\n",
            RUN,
            "its part `odd` is stopped, because it raised Odd",
        ),
    ],
)
def test_an_error_without_words_is_named_by_its_type(
    manifest: str, code: str, words: list[str], fault: str, installed: Installed, hall: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    installed.write("faulty", manifest, faulty_code=code)
    main(words)
    told = capsys.readouterr()
    assert FAULT + fault in told.out + told.err


def test_a_value_without_a_repr_is_named_by_its_type() -> None:
    class Odd:
        def __repr__(self) -> str:
            raise ValueError

    assert shown(Odd()) == "<Odd>"
