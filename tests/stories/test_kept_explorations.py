"""The same files are explored once: the result is stored, and used for these files alone."""

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import pytest

import lumen
from lumen.cli.main import main
from lumen.run.exploring import explored
from lumen.run.kept_explorations import MAX_KEPT, KeptExplorations


@pytest.fixture
def root(story: Callable[..., Path]) -> Path:
    """A project with something to find, and an unreachable state."""
    found = story("  - wait: 1s\n")
    door = found / "behaviors/door.yaml"
    door.write_text(door.read_text() + "properties:\n  it never opens: {always: \"!In('open')\"}\n")
    return found


def told(root: Path, capsys: pytest.CaptureFixture[str], *words: str) -> tuple[int, dict[str, object]]:
    code = main(["test", str(root), "--explore", "--behavior", "door", "--format", "json", *words])
    return code, json.loads(capsys.readouterr().out)["explore"]


def test_the_second_time_the_same_is_told_without_a_search(
    root: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    code, first = told(root, capsys)
    assert (code, first["known"], bool(first["findings"])) == (1, False, True)
    with monkeypatch.context() as patched:
        patched.setattr("lumen.cli.test.explored", None)
        assert told(root, capsys) == (1, {**first, "known": True})
        main(["test", str(root), "--explore", "--behavior", "door"])
        assert "(kept from an earlier run of the same files): " in capsys.readouterr().out
    assert not told(root, capsys, "--bound", "2")[1]["known"]
    door = root / "behaviors/door.yaml"
    door.write_text(door.read_text().replace("it never opens", "it stays shut"))
    assert not told(root, capsys)[1]["known"]


@pytest.mark.parametrize("text", ["", "[]", "{", '{"behavior": "door"}', '{"findings": [3], "unseen": [], "kept": []}'])
def test_a_file_that_is_none_is_explored_anew(text: str, root: Path) -> None:
    memory, found = (project := lumen.load(root)) and (KeptExplorations(project), explored(project, "door", bound=9))
    memory.keep(found, 9, "")
    assert memory.recall("door", 9, "") == replace(found, known=True)
    (file,) = (root / ".lumen/explored").glob("*.json")
    file.write_text(text)
    assert memory.recall("door", 9, "") is None


def test_the_oldest_give_way(root: Path) -> None:
    memory, found = (project := lumen.load(root)) and (KeptExplorations(project), explored(project, "door", bound=9))
    for bound in range(MAX_KEPT + 5):
        memory.keep(found, bound, "")
    assert len(list((root / ".lumen/explored").glob("*.json"))) == MAX_KEPT
    assert memory.recall("door", MAX_KEPT + 4, "")
