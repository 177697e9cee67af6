"""The stand-in for social media writes what would be posted."""

import json
from collections.abc import Callable
from pathlib import Path

import pytest

from lumen.features.social import module as social
from lumen.features.social.module import Social
from tests.features.conftest import Stand

Make = Callable[..., Stand]
EXPRESSION, PERCEPTION = "lumen.NAO.social.expression", "lumen.NAO.social.perception"


def test_a_post_is_a_line_in_the_file(stand: Make, tmp_path: Path) -> None:
    here, file = stand(), tmp_path / "posts.jsonl"
    here.add(Social(here.project, here.bus, here.told.append, file))
    perceived = here.listen(PERCEPTION)
    here.bus.publish(EXPRESSION, {"text": "Good morning,\nBandung!", "image": "data:image/jpeg;base64,AAAA"})
    here.bus.publish(EXPRESSION, {"text": "Selamat pagi!"})
    assert [body["kind"] for body in perceived.wait(2)] == ["posted", "posted"]
    first, second = (json.loads(line) for line in file.read_text().splitlines())
    assert (first["text"], first["image"]) == ("Good morning,\nBandung!", "data:image/jpeg;base64,AAAA")
    assert second["text"] == "Selamat pagi!"
    assert file.stat().st_mode & 0o077 == 0


def test_what_can_not_be_posted_is_one_line(stand: Make, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    here = stand()
    here.add(Social(here.project, here.bus, here.told.append, tmp_path))
    here.bus.publish(EXPRESSION, {"text": " "})
    here.bus.publish(EXPRESSION, {"text": "Hello"})
    here.settle()
    assert here.told == [
        f"a message on {EXPRESSION} needs a `text`: nothing was posted",
        f"{tmp_path} cannot be written: Is a directory",
    ]
    full = stand()
    full.add(Social(full.project, full.bus, full.told.append, tmp_path / "posts.jsonl"))
    monkeypatch.setattr(social, "MAX_FILE_BYTES", 10)
    for _ in range(2):
        full.bus.publish(EXPRESSION, {"text": "Hello"})
    full.settle()
    assert full.told == [f"{tmp_path / 'posts.jsonl'} is full: move it away so that new posts can be kept"]
