"""What was heard in a run, each sound at its time: the sound of its film."""

from collections.abc import Callable
from typing import Any

from lumen.run.sound import Sound

RATE = 44_100
"""Of the track [1/s]."""


class AudioTrack:
    """Sounds at their times [s], which may overlap; `mixed` is all of them."""

    def __init__(self) -> None:
        self._heard: list[tuple[float, Sound]] = []

    def __len__(self) -> int:
        return len(self._heard)

    def add(self, sound: Sound, at: float) -> Callable[[float], None]:
        """One that begins at that time; what to call where it ends early, with that time."""
        number = len(self._heard)
        self._heard.append((max(at, 0.0), sound))

        def cut(end: float) -> None:
            begin, whole = self._heard[number]
            self._heard[number] = (begin, whole.until(end - begin))

        return cut

    def mixed(self, length: float) -> Sound:
        """What is heard from time 0 until `length` [s]; where several together are too loud the peaks are cut."""
        import numpy as np  # a fifth of what `lumen run` imports, and only a film needs it here

        whole: Any = np.zeros(round(length * RATE), np.int32)
        for at, sound in self._heard:
            begin = round(at * RATE)
            part = _resampled(sound)[: max(len(whole) - begin, 0)]
            whole[begin : begin + len(part)] += part
        return Sound(RATE, whole.clip(-32_768, 32_767).astype("<i2").tobytes())


def _resampled(sound: Sound) -> Any:
    """Its samples at the track's rate, by straight lines between its own."""
    import numpy as np

    samples = np.frombuffer(sound.samples, "<i2")
    if sound.rate == RATE:
        return samples.astype(np.int32)
    times = np.arange(round(len(samples) * RATE / sound.rate)) * (sound.rate / RATE)
    return np.interp(times, np.arange(len(samples)), samples).round().astype(np.int32)
