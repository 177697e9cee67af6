"""The audio track of a run's film: each sound at the time it was played."""

from collections.abc import Callable
from typing import Any

from lumen.run.sound import Sound

RATE = 44_100
"""The sample rate of the track [1/s]."""


class AudioTrack:
    """Sounds with their start times [s], which may overlap; `mixed` combines them."""

    def __init__(self) -> None:
        self._heard: list[tuple[float, Sound]] = []

    def __len__(self) -> int:
        return len(self._heard)

    def add(self, sound: Sound, at: float) -> Callable[[float], None]:
        """Add a sound that begins at `at` [s]; return a function that cuts it off at a later time [s]."""
        number = len(self._heard)
        self._heard.append((max(at, 0.0), sound))

        def cut(end: float) -> None:
            begin, whole = self._heard[number]
            self._heard[number] = (begin, whole.until(end - begin))

        return cut

    def mixed(self, length: float) -> Sound:
        """Return the sum of all sounds from time 0 to `length` [s], clipped to 16 bits."""
        import numpy as np  # a fifth of what `lumen run` imports, and only a film needs it here

        whole: Any = np.zeros(round(length * RATE), np.int32)
        for at, sound in self._heard:
            begin = round(at * RATE)
            part = _resampled(sound)[: max(len(whole) - begin, 0)]
            whole[begin : begin + len(part)] += part
        return Sound(RATE, whole.clip(-32_768, 32_767).astype("<i2").tobytes())


def _resampled(sound: Sound) -> Any:
    """Return a sound's samples at the track's rate, by linear interpolation."""
    import numpy as np

    samples = np.frombuffer(sound.samples, "<i2")
    if sound.rate == RATE:
        return samples.astype(np.int32)
    times = np.arange(round(len(samples) * RATE / sound.rate)) * (sound.rate / RATE)
    return np.interp(times, np.arange(len(samples)), samples).round().astype(np.int32)
