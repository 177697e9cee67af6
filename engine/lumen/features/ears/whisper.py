"""Whisper, with a model in CTranslate2's format from a local folder, run by faster-whisper."""

import re
from collections.abc import Sequence
from functools import partial
from math import exp
from pathlib import Path
from typing import Any

from lumen.errors import ModuleError
from lumen.features.ears.recogniser import Hypothesis, RankingRecogniser
from lumen.features.ears.resampling import resampled
from lumen.features.ears.shared_recogniser import SharedRecogniser
from lumen.run.sound import Sound

INSTALL_WHISPER = "pip install 'lumen-robot[ears-whisper]'"
SAMPLE_RATE = 16_000
"""The sampling rate of Whisper's models [Hz]."""
FILES = ("config.json", "model.bin", "tokenizer.json")
"""The files that a model's folder must contain, because faster-whisper would download missing ones."""
NO_SPEECH = 0.6
"""Segments with at least this probability of silence are ignored, as in OpenAI's program, because Whisper invents
sentences in silence.
"""
_NO_WORD = re.compile(r"[^\w\s'’-]|_")


class Whisper(RankingRecogniser):
    """The model in a folder, which ignores expected sentences and returns at most one text for each sound.

    Each sound is recognised in the likeliest of the `languages`. An engine with the methods of faster-whisper's
    `WhisperModel` can be passed in. Raises ModuleError if the package or folder is unusable, or the model supports none
    of the languages.
    """

    def __init__(self, folder: Path, languages: Sequence[str], engine: Any = None) -> None:
        self._engine = engine or _loaded(folder)
        known = set(self._engine.supported_languages)
        self.languages = tuple(language for language in languages if language.partition("-")[0] in known)
        if not self.languages:
            raise ModuleError(
                f"the model in {folder} understands none of {', '.join(languages)}: use a multilingual model"
            )

    def expect(self, sentences: Sequence[Sequence[str]]) -> None:
        """Do nothing, because Whisper does not use expected sentences."""

    def hypotheses(self, sound: Sound) -> Sequence[Hypothesis]:
        """Return the text of a sound as a single hypothesis; an empty list if nothing is said.

        Raises ModuleError if Whisper fails on the sound.
        """
        import numpy as np

        samples = np.frombuffer(resampled(sound, SAMPLE_RATE).samples, "<i2").astype(np.float32) / 32_768
        try:
            parts, _ = self._engine.transcribe(
                samples, language=self._language(samples), temperature=0.0, condition_on_previous_text=False
            )
            said = [part for part in parts if part.no_speech_prob < NO_SPEECH]
        except (RuntimeError, ValueError) as error:
            raise ModuleError(f"Whisper failed on a sound: {error}") from None
        text = " ".join(_NO_WORD.sub(" ", " ".join(part.text for part in said)).split())
        if not text:
            return []
        return [Hypothesis(text, min(1.0, exp(sum(part.avg_logprob for part in said) / len(said))))]

    def _language(self, samples: Any) -> str:
        codes = [language.partition("-")[0] for language in self.languages]
        if len(codes) == 1:
            return codes[0]
        _, _, chances = self._engine.detect_language(samples)
        found = dict(chances)
        return max(codes, key=lambda code: found.get(code, 0.0))


def shared_whisper(folder: Path, languages: Sequence[str]) -> SharedRecogniser:
    """Return a recogniser that shares the process's Whisper model from a folder."""
    return SharedRecogniser(f"whisper {folder}", partial(Whisper, folder, languages))


def _loaded(folder: Path) -> Any:
    """Return the model in a folder, with 8-bit weights on the CPU. Raises ModuleError if it can't be loaded."""
    if not folder.is_dir():
        raise ModuleError(f"the folder {folder}, which `whisper` names, does not exist: put a CTranslate2 model there")
    missing = [name for name in FILES if not (folder / name).is_file()]
    if missing:
        how = "ct2-transformers-converter --model NAME --copy_files tokenizer.json preprocessor_config.json"
        raise ModuleError(
            f"{folder} is not a Whisper model for CTranslate2, because it has no "
            f"{', '.join(missing)}: make one with `{how}`"
        )
    try:
        from faster_whisper import WhisperModel
    except ImportError as error:
        raise ModuleError(
            f"Whisper needs faster-whisper, which cannot be imported ({error}): {INSTALL_WHISPER}"
        ) from None
    try:
        return WhisperModel(str(folder), device="cpu", compute_type="int8", local_files_only=True)
    except Exception as error:  # the engine, the tokenizer and json raise different errors for damaged files
        raise ModuleError(
            f"faster-whisper cannot load the model in {folder}: {str(error).splitlines()[0][:200]}"
        ) from None
