"""Whisper from a folder: with a fake engine, and with folders that hold no model."""

import sys
from collections.abc import Callable
from math import log
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from lumen.errors import ModuleError
from lumen.features.ears.module import Ears, Hypothesis
from lumen.features.ears.whisper import FILES, Whisper
from lumen.run.sound import Sound
from tests.features.conftest import Stand, with_options

SOUND = Sound(8_000, b"\x00\x40" * 4_000)


class Engine:
    """A stand-in for faster-whisper's `WhisperModel` with the methods that Lumen calls."""

    def __init__(self, *said: tuple[str, float, float], languages: tuple[str, ...] = ("en", "id", "de")) -> None:
        self.said, self.supported_languages = said, languages
        self.asked: list[Any] = []

    def detect_language(self, samples: Any) -> tuple[str, float, list[tuple[str, float]]]:
        return "ms", 0.5, [("ms", 0.5), ("id", 0.3), ("en", 0.2)]

    def transcribe(self, samples: Any, **options: Any) -> tuple[Any, None]:
        self.asked.append((samples, options))
        return (SimpleNamespace(text=t, avg_logprob=log(p), no_speech_prob=n) for t, p, n in self.said), None


def test_gives_words_and_how_sure_it_is() -> None:
    engine = Engine((" My name is", 0.9, 0.1), (" O'Neil.", 0.4, 0.1), (" Thanks for watching!", 0.9, 0.8))
    whisper = Whisper(Path("w"), ["en", "id"], engine)
    assert whisper.hypotheses(SOUND) == [Hypothesis("My name is O'Neil", pytest.approx(0.6))]
    assert whisper.recognise(SOUND) == "My name is O'Neil"
    [(samples, options), _] = engine.asked
    assert (samples.dtype, len(samples), samples.max()) == (np.float32, 8_000, 0.5), "half a second at 16 kHz"
    assert options["language"] == "id", "the likeliest of those that are spoken here"


def test_silence_says_nothing() -> None:
    assert Whisper(Path("w"), ["en"], Engine()).hypotheses(SOUND) == []
    assert Whisper(Path("w"), ["en"], Engine((" ...", 0.9, 0.1))).hypotheses(SOUND) == []


def test_a_model_of_other_languages_is_refused() -> None:
    assert Whisper(Path("w"), ["en-GB", "jv"], Engine()).languages == ("en-GB",)
    with pytest.raises(ModuleError, match="understands none of jv: use a multilingual model"):
        Whisper(Path("w"), ["jv"], Engine())


def test_an_engine_that_fails_costs_one_sound() -> None:
    engine = Engine()
    engine.transcribe = lambda *_, **__: (_ for _ in ()).throw(RuntimeError("out of memory"))  # type: ignore[method-assign]
    with pytest.raises(ModuleError, match="Whisper failed on a sound: out of memory"):
        Whisper(Path("w"), ["en"], engine).hypotheses(SOUND)


def test_a_folder_that_is_none_says_what_it_should_hold(tmp_path: Path) -> None:
    with pytest.raises(ModuleError, match=r"the folder .*nowhere, which `whisper` names, does not exist"):
        Whisper(tmp_path / "nowhere", ["en"])
    (tmp_path / "config.json").write_text("{}")
    with pytest.raises(
        ModuleError, match=r"it has no model\.bin, tokenizer\.json: make one with `ct2-transformers-converter"
    ):
        Whisper(tmp_path, ["en"])


def test_without_the_package_it_says_what_to_install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in FILES:
        (tmp_path / name).write_text("{}")
    monkeypatch.setitem(sys.modules, "faster_whisper", None)
    with pytest.raises(ModuleError, match=r"pip install 'lumen-robot\[ears-whisper\]'"):
        Whisper(tmp_path, ["en"])


def test_a_model_that_can_not_be_loaded_is_a_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for name in FILES:
        (tmp_path / name).write_text("{}")

    def broken(folder: str, **options: Any) -> None:
        assert (folder, options["local_files_only"]) == (str(tmp_path), True)
        raise RuntimeError("Unsupported model binary version\nat line 3")

    monkeypatch.setitem(sys.modules, "faster_whisper", SimpleNamespace(WhisperModel=broken))
    with pytest.raises(ModuleError, match=r"cannot load the model in .*: Unsupported model binary version$"):
        Whisper(tmp_path, ["en"])


def test_the_ears_take_the_folder_of_the_settings(stand: Callable[..., Stand], tmp_path: Path) -> None:
    here = stand()
    project = with_options(here.project, "ears", whisper=str(tmp_path / "whisper-base"))
    with pytest.raises(ModuleError, match="whisper-base, which `whisper` names, does not exist"):
        Ears(project, here.bus, here.told.append)
