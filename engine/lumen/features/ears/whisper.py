"""Whisper, from a folder of the house: a model in the format of CTranslate2, run by faster-whisper."""

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
"""What its models were made from [Hz]."""
FILES = ("config.json", "model.bin", "tokenizer.json")
"""What a folder has to hold: what is missing would be fetched from the Hub, and nothing is fetched here."""
NO_SPEECH = 0.6
"""A part that is so surely no speech is none, as OpenAI's own program has it: Whisper writes sentences into silence."""
_NO_WORD = re.compile(r"[^\w\s'’-]|_")


class Whisper(RankingRecogniser):
    """The model of a folder; it is told nothing of what is expected, and knows one text for each sound.

    Of the `languages` it takes the one that is likeliest for a sound. An engine of one's own may be handed in, with the
    methods of faster-whisper's `WhisperModel`. Raises ModuleError where the package or the folder is none.
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
        """Whatever is said: it knows its languages."""

    def hypotheses(self, sound: Sound) -> Sequence[Hypothesis]:
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
    """The process's Whisper of that folder."""
    return SharedRecogniser(f"whisper {folder}", partial(Whisper, folder, languages))


def _loaded(folder: Path) -> Any:
    """The model of a folder, in eight bits on the processor. Raises ModuleError."""
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
    except Exception as error:  # what a broken file raises is the engine's, the tokenizer's or json's own
        raise ModuleError(
            f"faster-whisper cannot load the model in {folder}: {str(error).splitlines()[0][:200]}"
        ) from None
