"""The result of a gait search is written into a body's file, in its units, and keeps the rest of the file."""

from argparse import Namespace
from pathlib import Path

import pytest
import search_gait
import yaml

from lumen.run.workers.workers import Workers

FILE = "name: Other\nunits: {angle: deg, length: cm}\njoints: {}\n"


def test_it_is_written_at_the_end_in_the_files_units() -> None:
    text = search_gait.written(FILE, "usual", {"single": 0.3, "forward": 0.05, "lean": 0.05236})
    assert text.startswith(FILE)
    assert yaml.safe_load(text)["gait"]["usual"] == pytest.approx({"single": 0.3, "forward": 5, "lean": 3}, rel=1e-4)


def test_what_was_found_before_stays() -> None:
    text = search_gait.written(FILE, "usual", {"single": 0.3, "double": 0.1})
    text = search_gait.written(search_gait.written(text, "brisk", {"forward": 0.06}), "usual", {"single": 0.25})
    assert yaml.safe_load(text)["gait"] == {"usual": {"single": 0.25, "double": 0.1}, "brisk": {"forward": 6}}


def test_what_follows_it_is_not_lost() -> None:
    with pytest.raises(SystemExit, match="at the end"):
        search_gait.written("joints: {}\ngait:\n  usual: {}\nname: Other\n", "usual", {})


@pytest.mark.soak
def test_two_processes_try_what_one_tries_and_go_on_where_it_ended(tmp_path: Path) -> None:
    """Eight robots walk for half a second each, in four programs with a simulation of their own."""
    said = {"model": "nao", "pace": "usual", "robots": 1, "seconds": 0.5, "seed": 3}
    first = search_gait.search(Namespace(tries=2, **said), Workers(1), tmp_path / "one")
    assert search_gait.search(Namespace(tries=2, **said), Workers(2), tmp_path / "two") == first
    longer = search_gait.search(Namespace(tries=4, **said), Workers(2), tmp_path / "two")
    assert search_gait.search(Namespace(tries=4, **said), Workers(1), tmp_path / "one") == longer
    (one,), (two,) = ((tmp_path / name).iterdir() for name in ("one", "two"))
    assert one.read_text() == two.read_text()
    assert len(one.read_text().splitlines()) == 4
