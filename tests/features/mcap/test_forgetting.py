"""A name that was forgotten is in no byte of any recording, nor is a picture of when it was said."""

from pathlib import Path

import orjson

from lumen.features.mcap.files.reading import read_recording
from lumen.features.mcap.files.recorded import RecordedMessage
from lumen.features.mcap.recordings_folder import RecordingsFolder
from lumen.run.forgetting.added import Forgetting
from lumen.run.forgetting.files import forget_in
from tests.features.mcap.making import bodies, encoded, picture, said, write


def test_forgetting_reaches_recordings_here_and_elsewhere(tmp_path: Path) -> None:
    home, elsewhere = tmp_path / ".lumen", tmp_path / "elsewhere.mcap"
    folder = RecordingsFolder(home)
    folder.make()
    named = write(
        folder.path / "a.mcap",
        picture(-700.0),
        picture(-500.0),
        said("lumen.heard", {"result": "I am Ani", "who": {"Ani": ["ANI"]}}),
        picture(500.0),
        picture(700.0),
        said("lumen.heard", {"result": "an animal"}, 800.0),
    )
    other = write(folder.path / "b.mcap", said("lumen.heard", {"result": "I am Budi"}), picture())
    note = folder.begin(write(elsewhere, said("lumen.heard", {"result": "Ani?"})))
    assert note
    note.release()
    before = other.read_bytes()
    found = Forgetting()
    forget_in(home, "Ani", found)
    assert found.left == []
    assert {place.where for place in found.deleted} == {str(named), str(elsewhere)}
    assert "pictures and sounds: 2" in next(place.what for place in found.deleted if place.where == str(named))
    assert other.read_bytes() == before
    for path in (named, elsewhere):
        texts = [orjson.loads(item.data) for item in read_recording(path) if _is_json(item)]
        assert "ani" not in str(texts).lower().replace("animal", "")
    assert [topic.rpartition(".")[2] for topic, _ in bodies(named)].count("image") == 2
    again = Forgetting()
    forget_in(home, "Ani", again)
    assert again.deleted == again.left == []


def test_nothing_is_forgotten_for_good_that_is_somebody_else_s(tmp_path: Path) -> None:
    path = write(tmp_path / "a.mcap", said("lumen.heard", {"result": "I am Anita"}))
    before = bodies(path)
    folder = RecordingsFolder(tmp_path / ".lumen")
    note = folder.begin(path)
    assert note
    note.release()
    forget_in(tmp_path / ".lumen", "Ani", Forgetting())
    assert bodies(path) == before
    assert len(before) == len(encoded(said("lumen.heard", {})))


def _is_json(item: object) -> bool:
    return isinstance(item, RecordedMessage) and item.channel.encoding == "json"
