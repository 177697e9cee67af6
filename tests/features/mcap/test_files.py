"""A recording is readable by others, whole or cut, and cut ones are recovered."""

import json
import random
import shutil
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from lumen.cli.main import main
from lumen.errors import RecordingError
from lumen.features.mcap.files.encoding import origin_of
from lumen.features.mcap.files.foxglove import form_class
from lumen.features.mcap.files.reading import read_recording, whole
from lumen.features.mcap.files.recorded import RecordedFile, RecordedMessage, RecordedNotes
from lumen.features.mcap.files.recording_file import RecordingFile, writable
from lumen.features.mcap.files.rewriting import recover, rewrite
from lumen.language.projects import Project
from tests.features.mcap.making import BEGAN, JPEG, bodies, encoded, picture, readable, said, write
from tests.journal.making import minimal

JSON = st.recursive(
    st.none() | st.booleans() | st.integers(-(2**53), 2**53) | st.floats(-1e9, 1e9) | st.text(),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text() | st.just("_lumen"), inner, max_size=3),
    max_leaves=6,
)


@given(JSON)
@settings(max_examples=40)
def test_a_body_and_where_it_came_from_come_back(body: object) -> None:
    (item,) = encoded(said("lumen.some.key", body))
    found, origin = origin_of(json.loads(item.data))
    assert found == body
    assert origin == {"id": "m0", "sender": "a test", "cause": "d3"}
    assert (item.came, item.sent) == (int(BEGAN * 1e9), int(BEGAN * 1e9))


def test_what_json_lacks_becomes_null_and_half_a_sign_is_kept() -> None:
    (item,) = encoded(said("lumen.some.key", {"text": "a\ud800", "angles": [float("nan"), -float("inf"), 2**70]}))
    found, _ = origin_of(strict_json(item.data))
    assert found == {"text": "a\ud800", "angles": [None, None, 2**70]}


def strict_json(data: bytes) -> object:
    def refuse(name: str) -> None:
        raise AssertionError(f"{name} is not JSON")

    return json.loads(data, parse_constant=refuse)


def test_a_picture_is_a_compressed_image_of_the_very_bytes(tmp_path: Path) -> None:
    (image, about) = bodies(write(tmp_path / "a.mcap", picture()))
    found = form_class("CompressedImage").FromString(image[1])
    assert (found.data, found.format, image[0]) == (JPEG, "jpeg", "avatar.NAO.data.image")
    assert about == ("avatar.NAO.data.image.about", {"name": "1", "contentType": "image/jpeg"})


def test_a_message_has_its_route_s_schema() -> None:
    from dataclasses import replace

    import orjson

    from lumen.features.mcap.files.encoding import MessageEncoder

    project: Project = minimal()
    schema = {"type": "object", "properties": {"result": {"type": "string"}}, "required": ["result"]}
    project = replace(project, messages={**project.messages, "speech.recognition": schema})
    route = project.routes["heard"]
    assert route.schema == "speech.recognition"
    (item,) = MessageEncoder(project).encode(said(route.key_for(project.robot), {"result": "hello"}), BEGAN)
    assert item.channel.form == "lumen.speech.recognition"
    written = orjson.loads(item.channel.schema)
    assert written["required"] == ["result"]
    assert {"result", "_lumen"} == set(written["properties"])


@pytest.fixture(scope="module")
def long(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    """The bytes of a recording with some chunks and attachments, without an end."""
    path = tmp_path_factory.mktemp("long") / "long.mcap"
    file = RecordingFile(path)
    file.write([RecordedNotes("lumen", (("robot", "NAO"),)), RecordedFile("a.zip", "application/zip", b"zip", 1)])
    for number in range(60):
        file.write(encoded(said("lumen.a", {"number": number}, number), picture(number)))
        if number % 5 == 4:
            file._writer.flush()
    file._file.flush()
    data = path.read_bytes()
    file.finish()
    return data


@given(st.randoms(use_true_random=False))
@settings(max_examples=8, suppress_health_check=[HealthCheck.function_scoped_fixture])
def test_a_cut_leaves_a_prefix_that_others_read_and_that_is_recovered(
    tmp_path: Path, long: bytes, random: random.Random
) -> None:
    cut(tmp_path, long, random.randrange(8, len(long)))


@pytest.mark.soak
def test_a_cut_at_every_byte(tmp_path: Path, long: bytes) -> None:
    for at in range(8, len(long), 7):
        cut(tmp_path, long, at)


def cut(folder: Path, data: bytes, at: int) -> None:
    path = folder / "cut.mcap"
    path.write_bytes(data[:at])
    before, every = list(readable(data[:at])), list(readable(data))
    assert before == every[: len(before)]
    assert [item.data for item in read_recording(path) if isinstance(item, RecordedMessage)] == before
    assert not whole(path)
    assert recover(path) == len(before)
    assert whole(path)
    assert len(bodies(path)) == len(before)
    assert recover(path) is None


def test_what_was_closed_for_half_a_second_survives(long: bytes) -> None:
    last = bytes(list(readable(long))[-1])
    assert JPEG in last or b"59" in last


def test_damage_in_the_middle_ends_what_is_read(tmp_path: Path, long: bytes) -> None:
    path = tmp_path / "a.mcap"
    path.write_bytes(long[: len(long) // 2] + b"\xff" * 50 + long[len(long) // 2 + 50 :])
    found = [item for item in read_recording(path) if isinstance(item, RecordedMessage)]
    assert 0 < len(found) < len(list(readable(long)))


def test_several_become_one_and_attachments_are_kept(tmp_path: Path, long: bytes) -> None:
    (tmp_path / "a.mcap").write_bytes(long)
    write(tmp_path / "b.mcap", said("lumen.b", {"last": True}, 70))
    count = rewrite([tmp_path / "a.mcap", tmp_path / "b.mcap"], tmp_path / "c.mcap")
    found = list(read_recording(tmp_path / "c.mcap"))
    assert count == sum(isinstance(item, RecordedMessage) for item in found) == len(bodies(tmp_path / "c.mcap"))
    assert RecordedFile("a.zip", "application/zip", b"zip", 1) in found
    assert [path.name for path in sorted(tmp_path.iterdir())] == ["a.mcap", "b.mcap", "c.mcap"]


def test_what_is_no_recording_is_said_to_be_none(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "a.mcap"
    path.write_text("hello")
    with pytest.raises(RecordingError, match="not a recording"):
        list(read_recording(path))
    assert main(["record", "--recover", str(path)]) == 2
    assert "is not a recording" in capsys.readouterr().err
    assert path.read_text() == "hello"
    assert main(["record", "--recover", str(tmp_path / "none.mcap")]) == 2


def test_the_verb_recovers(tmp_path: Path, long: bytes, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "a.mcap"
    path.write_bytes(long)
    shutil.copy(path, tmp_path / "a.mcap.123.new")
    assert main(["record", "--recover", str(path)]) == 0
    assert "is complete again: 180 messages" in capsys.readouterr().out
    assert main(["record", "--recover", str(path)]) == 0
    assert "nothing to recover" in capsys.readouterr().out
    assert not (tmp_path / "a.mcap.123.new").exists()


def test_a_recording_never_takes_the_place_of_another(tmp_path: Path) -> None:
    assert writable(tmp_path / "a.mcap") == tmp_path / "a.mcap"
    (tmp_path / "a.mcap").touch()
    assert writable(tmp_path / "a.mcap") == tmp_path / "a-2.mcap"
    with pytest.raises(RecordingError, match=r"the folder .* does not exist"):
        writable(tmp_path / "none" / "a.mcap")
