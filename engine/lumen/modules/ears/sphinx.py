"""PocketSphinx, which carries its model of American English in its own package and needs no network."""

from typing import Any

from lumen.errors import ModuleError
from lumen.modules.sound import Sound

INSTALL = "pip install 'lumen-robot[ears]'"
RATE = 16_000
"""What its model was made from [Hz]."""
REST = bytes(RATE)
"""Half a second of silence: it wants some before and after."""


class Sphinx:
    """English, freely spoken, in about real time. Raises ModuleError where the package or its model is missing."""

    languages: tuple[str, ...] = ("en",)

    def __init__(self) -> None:
        try:
            from pocketsphinx import Decoder
        except ImportError as error:
            raise ModuleError(f"speech needs PocketSphinx, which can't be imported ({error}): {INSTALL}") from None
        try:
            self._decoder: Any = Decoder(samprate=RATE, loglevel="FATAL")
        except (RuntimeError, ValueError) as error:
            raise ModuleError(f"PocketSphinx can't load its model ({error}): {INSTALL} again") from None

    def recognise(self, sound: Sound) -> str:
        decoder = self._decoder
        decoder.start_utt()
        decoder.process_raw(REST + resampled(sound, RATE).samples + REST, full_utt=True)
        decoder.end_utt()
        found = decoder.hyp()
        return str(found.hypstr) if found else ""


def resampled(sound: Sound, rate: int) -> Sound:
    """The sound at another rate, linearly between its samples."""
    if sound.rate == rate:
        return sound
    import numpy as np

    samples = np.frombuffer(sound.samples, "<i2")
    count = max(1, round(len(samples) * rate / sound.rate))
    places = np.linspace(0.0, len(samples) - 1.0, count)
    return Sound(rate, np.interp(places, np.arange(len(samples)), samples).astype("<i2").tobytes())
