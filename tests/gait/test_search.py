"""What a search of a gait found is written into a body's file, in its units, beside what stands there."""

import pytest
import search_gait
import yaml

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
