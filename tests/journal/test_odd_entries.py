"""A journal comes from a disk or another person: odd entries are reported, and raise no other error."""

import json
import random
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

import lumen
from lumen.cli.main import main
from lumen.journal.journal_file import FramePacker, encode, read_header, read_lines
from tests import ROOT
from tests.copying import copied_project
from tests.tables import for_each

ODD: tuple[Any, ...] = (
    None, True, -1, 7, 10**400, 1e308, float("nan"), "", "soon", "\ud800", "a" * 70_000, [], [[]], [1], ["x", "y"],
    {}, {"x": 1}, {"at": []}, [{"id": "d1"}],
)  # fmt: skip


@pytest.fixture(scope="module")
def played(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The journal of a small exhibition after a visit."""
    folder = copied_project(ROOT / "examples/minimal", tmp_path_factory.mktemp("odd") / "minimal")
    (story,) = lumen.load(folder).stories
    with lumen.open(folder, story=story) as exhibition:
        exhibition.run()
    (file,) = (folder / ".lumen" / "journal" / "rehearsed").glob("*.journal")
    return file


def places(data: Any, path: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Yield the path to each value in JSON data, from the outside to the inside."""
    below = data.items() if isinstance(data, dict) else enumerate(data) if isinstance(data, list) else ()
    for key, value in below:
        yield (*path, key)
        yield from places(value, (*path, key))


def with_odd(entry: Any, chance: random.Random) -> Any:
    """Return the entry with an odd value at one of its places, or without that place."""
    place = chance.choice(list(places(entry)))
    inside = entry
    for key in place[:-1]:
        inside = inside[key]
    if isinstance(inside, dict) and chance.random() < 0.2:
        del inside[place[-1]]
    else:
        inside[place[-1]] = chance.choice(ODD)
    return entry


def oddly(file: Path, chance: random.Random) -> str:
    """Rewrite the journal with some odd entries; return a description of them."""
    header = read_header(file.read_bytes().split(b"\n", 1)[0], file.name)
    rows = [json.loads(line) for line in read_lines(file)]
    told = []
    for number in chance.sample(range(len(rows)), 3):
        rows[number] = with_odd(rows[number], chance)
        told.append(rows[number])
    text = "".join(encode(row) + "\n" for row in rows).encode("utf-8", "surrogatepass")
    file.write_bytes(header.line() + FramePacker().pack(text))
    return repr(told)[:2000]


@for_each(
    "words",
    [
        ["replay", "--format", "json"],
        ["replay", "--until", "12:00"],
        ["replay", "--bundle", "."],
        ["replay", "--robot", "recording", "--speed", "max"],
        ["why"],
        ["why-not", "greet"],
    ],
)
def test_odd_entries_are_told(
    words: list[str], played: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    content = played.read_bytes()
    home = played.parents[3]
    monkeypatch.chdir(home)
    for seed in range(12):
        played.write_bytes(content)
        told = oddly(played, random.Random(seed))
        try:
            assert main(words) in (0, 1, 2), told
        except Exception as error:
            raise AssertionError(f"seed {seed}: {told}") from error
        said = capsys.readouterr()
        assert "Traceback" not in said.err + said.out, told
    played.write_bytes(content)
