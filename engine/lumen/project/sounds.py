"""Sound files of a project: WAV with 16 bits, one channel or two."""

import wave
from pathlib import Path

from lumen.project.files import on_disk

MAX_SOUND_DURATION = 600.0
"""The maximum duration of a sound [s]."""
RATES = (8_000, 96_000)
"""The lowest and the highest sample rate [Hz]."""


def sound_duration(root: Path, file: str) -> float:
    """Return the duration of a sound of the project [s].

    Raises FileNotFoundError if it is absent or outside the project, OSError if it can't be read, and ValueError with a
    reason if it can't be played.
    """
    path = on_disk(root, file)
    if not path.resolve().is_relative_to(root.resolve()) or not path.is_file():
        raise FileNotFoundError(f"there is no file {file} in the project")
    try:
        with path.open("rb") as opened, wave.open(opened) as sound:
            channels, bits, rate = sound.getnchannels(), 8 * sound.getsampwidth(), sound.getframerate()
            frames = min(sound.getnframes(), path.stat().st_size // (channels * bits // 8))
    except (wave.Error, EOFError):
        raise ValueError("it is not a WAV file with PCM samples") from None
    if bits != 16 or channels not in (1, 2) or not RATES[0] <= rate <= RATES[1]:
        raise ValueError(
            f"channels: {channels}, bits: {bits}, sample rate: {rate:,} Hz;"
            f" allowed are 1 or 2 channels, 16 bits and {RATES[0]:,} to {RATES[1]:,} Hz"
        )
    if not frames:
        raise ValueError("it is empty")
    if frames / rate > MAX_SOUND_DURATION:
        raise ValueError(f"it lasts {frames / rate:.0f} s, but the maximum is {MAX_SOUND_DURATION:g} s")
    return float(frames / rate)
