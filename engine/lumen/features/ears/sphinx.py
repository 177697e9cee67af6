"""PocketSphinx, whose package contains its model of American English, so it needs no network."""

import re
from collections import Counter, defaultdict
from collections.abc import Mapping, Sequence
from itertools import islice
from math import exp, log10
from pathlib import Path
from statistics import geometric_mean
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any

from lumen.errors import ModuleError
from lumen.features.ears.recogniser import Hypothesis, RankingRecogniser
from lumen.features.ears.resampling import resampled
from lumen.run.sound import Sound

_SOUNDS = {
    "ngg": "NG G", "ng": "NG", "ny": "N Y", "sy": "SH", "kh": "K", "ai": "AY", "au": "AW",
    "a": "AA", "b": "B", "c": "CH", "d": "D", "e": "AH", "f": "F", "g": "G", "h": "HH", "i": "IY", "j": "JH", "k": "K",
    "l": "L", "m": "M", "n": "N", "o": "OW", "p": "P", "q": "K", "r": "R", "s": "S", "t": "T", "u": "UW", "v": "F",
    "w": "W", "x": "K S", "y": "Y", "z": "Z",
}  # fmt: skip
"""The nearest of the 39 sounds in CMU's dictionary for Indonesian, whose spelling is phonetic."""

_LETTERS = re.compile("|".join(sorted(_SOUNDS, key=len, reverse=True)))


def pronounced(word: str) -> str:
    """Return the sounds of a lower-case word by PocketSphinx's names; empty if it has no letters from a to z."""
    return " ".join(_SOUNDS[letters] for letters in _LETTERS.findall(word))


COMMON_WEIGHT = 0.75
"""The share of a word's probability that comes from the language, not from the expected sentences.

A smaller share improves expected sentences in quiet places, but other talk is mistaken for one more often.
"""
SENTENCE_BEGIN, SENTENCE_END = "<s>", "</s>"


def arpa(sentences: Sequence[Sequence[str]], common: Mapping[str, float]) -> str:
    """Return the language model in ARPA's format; `common` are words with their probabilities.

    Bigrams are smoothed by Witten and Bell (1991): a word with many different successors leaves much probability to
    others. Without common words, all speech would be mistaken for expected sentences.
    """
    pairs = Counter(pair for s in sentences for pair in zip([SENTENCE_BEGIN, *s], [*s, SENTENCE_END], strict=True))
    seen: dict[str, int] = Counter()
    followers: dict[str, set[str]] = defaultdict(set)
    for (word, after), count in pairs.items():
        seen[word] += count
        followers[word].add(after)
    chances = _chances(Counter(after for _, after in pairs.elements()), common)
    known = {word: count / (count + len(followers[word])) for word, count in seen.items()}
    lines = ["\\data\\", f"ngram 1={len(chances) + 1}", f"ngram 2={len(pairs)}", "", "\\1-grams:"]
    lines.append(f"-99 {SENTENCE_BEGIN} {log10(1 - known[SENTENCE_BEGIN]):.4f}")
    lines += [f"{log10(p):.4f} {w} {log10(1 - known.get(w, 0.0)):.4f}" for w, p in sorted(chances.items())]
    lines += ["", "\\2-grams:"]
    for (word, after), count in sorted(pairs.items()):
        part = known[word]
        lines.append(f"{log10(part * count / seen[word] + (1 - part) * chances[after]):.4f} {word} {after}")
    return "\n".join([*lines, "", "\\end\\", ""])


def _chances(expected: Mapping[str, int], common: Mapping[str, float]) -> dict[str, float]:
    """Return the probability of each word, regardless of the word before it."""
    total, whole = sum(expected.values()), sum(common.values())
    share = COMMON_WEIGHT if common else 0.0
    chances = {word: (1 - share) * count / total for word, count in expected.items()}
    for word, chance in common.items():
        chances[word] = chances.get(word, 0.0) + share * chance / whole
    return chances


if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

INSTALL_EARS = "pip install 'lumen-robot[ears]'"
SAMPLE_RATE = 16_000
"""The sampling rate of the model [Hz]."""
REST_SAMPLES = SAMPLE_RATE // 2
"""Half a second of silence [samples], which the recogniser needs before and after the sound."""
NOISE_LEVEL = 40.0
"""The level of the noise added to each sound, of 32,768, because digital silence misleads the recogniser."""
SILENCE_LEVEL = 300
"""A sound that stays below this level, of 32,768, is silence."""
COMMON_WORDS = 8_000
"""The number of common words in a language model besides the expected words."""
MAX_MODELS = 4
"""The maximum number of language models that are kept; each needs 19 MB, and 0.15 s of processor time to make."""
LOG_STEP = 1e-4
"""The base of PocketSphinx's logarithms, minus 1."""

MAX_HYPOTHESES, MAX_EXAMINED = 5, 20
"""The maximum numbers of different texts returned and of hypotheses examined, many of which differ only in silences."""
FILLERS = "<[+"
"""The first characters of silences and noises, which are not words."""
TINY = 1e-9


class Sphinx(RankingRecogniser):
    """Recognises speech with a language model of the expected sentences, or of general English if there are none.

    It is faster than real time. Raises ModuleError if the package or its model is missing.
    """

    languages: tuple[str, ...] = ("en", "id")

    def __init__(self) -> None:
        try:
            import pocketsphinx
        except ImportError as error:
            raise ModuleError(
                f"speech recognition needs PocketSphinx, which cannot be imported ({error}): {INSTALL_EARS}"
            ) from None
        self._dictionary = Path(pocketsphinx.get_model_path("en-us/cmudict-en-us.dict"))
        try:
            self._decoder: Any = pocketsphinx.Decoder(samprate=SAMPLE_RATE, cmn="batch", loglevel="FATAL")
        except (RuntimeError, ValueError) as error:
            raise ModuleError(f"PocketSphinx cannot load its model ({error}): {INSTALL_EARS} again") from None
        self._freely = self._decoder.current_search()
        self._english = self._decoder.get_lm(self._freely)
        self._expected: Sequence[Sequence[str]] = ()
        self._models: dict[tuple[tuple[str, ...], ...], str] = {}
        self._common: dict[str, float] = {}

    def expect(self, sentences: Sequence[Sequence[str]]) -> None:
        """Set the sentences that are likely to be said."""
        self._expected = sentences

    def hypotheses(self, sound: Sound) -> Sequence[Hypothesis]:
        """Return the hypotheses for a sound, the best first; an empty list if nothing is said.

        Only the first has a confidence, because the others' scores hardly differ.
        """
        samples = _samples(sound)
        if abs(samples).max(initial=0) < SILENCE_LEVEL:
            return []
        self._prepare(self._expected)
        decoder = self._decoder
        decoder.reinit_feat()  # forget the noise of earlier sounds, so the result depends on this sound only
        decoder.start_utt()
        decoder.process_raw(_hissing(samples), full_utt=True)
        decoder.end_utt()
        best = decoder.hyp()
        if not best or not best.hypstr:
            return []
        sure = [segment.prob for segment in decoder.seg() if segment.word[0] not in FILLERS]
        confidence = min(1.0, geometric_mean(p or TINY for p in sure)) if sure else 0.0
        others = (found.hypstr for found in islice(decoder.nbest(), MAX_EXAMINED) if found.hypstr)
        texts = dict.fromkeys((best.hypstr, *others))
        return [Hypothesis(text, None if i else confidence) for i, text in enumerate(islice(texts, MAX_HYPOTHESES))]

    def _prepare(self, sentences: Sequence[Sequence[str]]) -> None:
        """Activate a recent or new language model of these sentences, or that of English if there are none."""
        spoken = (tuple(word for word in sentence if pronounced(word)) for sentence in sentences)
        key = tuple(sentence for sentence in spoken if sentence)
        name = self._models.pop(key, "") if key else self._freely
        if not name:
            full = len(self._models) == MAX_MODELS
            name = self._models.pop(next(iter(self._models))) if full else f"expected {len(self._models)}"
            self._make(name, key)
        if key:
            self._models[key] = name
        self._decoder.activate_search(name)

    def _make(self, name: str, sentences: Sequence[Sequence[str]]) -> None:
        self._common = self._common or self._commonest()
        for word in sorted({word for sentence in sentences for word in sentence}):
            if not self._decoder.lookup_word(word):
                self._decoder.add_word(word, pronounced(word), False)
        with TemporaryDirectory() as folder:
            file = Path(folder) / "expected.lm"
            file.write_text(arpa(sentences, self._common), "utf-8")
            self._decoder.add_lm_file(name, str(file))

    def _commonest(self) -> dict[str, float]:
        """Return the COMMON_WORDS most common words with their probabilities in the package's model."""
        lines = self._dictionary.read_text("utf-8").splitlines()
        words = [word for word in (line.partition(" ")[0] for line in lines) if "(" not in word]
        first = sorted(((self._english.prob([word]), word) for word in words), reverse=True)[:COMMON_WORDS]
        return {word: exp(chance * LOG_STEP) for chance, word in first}


def _samples(sound: Sound) -> "NDArray[np.float64]":
    import numpy as np

    return np.frombuffer(resampled(sound, SAMPLE_RATE).samples, "<i2").astype(float)


def _hissing(samples: "NDArray[np.float64]") -> bytes:
    """Return the samples with REST_SAMPLES added before and after, and with quiet noise that is always the same."""
    import numpy as np

    padded = np.pad(samples, REST_SAMPLES)
    noise = np.random.default_rng(0).normal(0.0, NOISE_LEVEL, padded.shape)
    data: bytes = np.clip(padded + noise, -32_768, 32_767).astype("<i2").tobytes()
    return data
