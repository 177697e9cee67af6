"""Sound as the modules of 2015 send it: WAV in base64, one channel of 16 bits."""

import base64
import binascii
import io
import sys
import wave
from array import array
from collections.abc import Iterable
from pathlib import Path
from typing import IO, NamedTuple

from lumen.errors import ModuleError

MAX_DURATION = 120.0
"""The longest sound in a message [s]."""


class Sound(NamedTuple):
    """Samples of 16 bits, little-endian, one channel."""

    rate: int
    """The number of samples per second [1/s]."""
    samples: bytes

    @property
    def duration(self) -> float:
        """The duration of the sound [s]."""
        return len(self.samples) / (2 * self.rate)

    def until(self, length: float) -> "Sound":
        """Return the beginning of the sound, at most `length` [s] long."""
        return self.between(0.0, length)

    def between(self, begin: float, end: float) -> "Sound":
        """Return the part between two times [s]; it is shorter if the sound ends earlier."""
        return Sound(self.rate, self.samples[self._at(begin) : self._at(end)])

    def without(self, spans: Iterable[tuple[float, float]]) -> "Sound":
        """Return a copy that is silent in each span from `begin` to `end` [s]."""
        data = bytearray(self.samples)
        for begin, end in spans:
            first, last = self._at(begin), min(self._at(end), len(data))
            data[first:last] = bytes(max(0, last - first))
        return Sound(self.rate, bytes(data))

    def _at(self, moment: float) -> int:
        return 2 * round(max(moment, 0.0) * self.rate)

    def at_volume(self, volume: float) -> "Sound":
        """Return a copy with each sample times `volume`, from 0 to 1."""
        if volume == 1.0:
            return self
        louder = array("h", self.samples)
        if sys.byteorder == "big":
            louder.byteswap()
        quieter = array("h", (round(sample * volume) for sample in louder))
        if sys.byteorder == "big":
            quieter.byteswap()
        return Sound(self.rate, quieter.tobytes())

    def text(self) -> str:
        """Return the sound as a WAV in base64."""
        data = io.BytesIO()
        _write(data, self)
        return base64.b64encode(data.getvalue()).decode("ascii")


def sound_of(text: object) -> Sound:
    """Return the sound of a WAV in base64.

    Raises ModuleError for any other text, and for an unsupported kind of WAV.
    """
    if not isinstance(text, str):
        raise ModuleError("a sound must be a string: a WAV file encoded in base64")
    try:
        data = base64.b64decode(text.partition("base64,")[2] or text, validate=True)
    except (binascii.Error, ValueError):
        raise ModuleError("a sound is ignored: it is not base64") from None
    return wav(data)


def wav(data: bytes) -> Sound:
    """Return the sound of a WAV file's bytes.

    Raises ModuleError unless it is a WAV file with one channel, 16 bits, 8 to 48 kHz, and 1 sample to MAX_DURATION.
    """
    try:
        with wave.open(io.BytesIO(data)) as file:
            channels, width, rate = file.getnchannels(), file.getsampwidth(), file.getframerate()
            kind = f"{channels} channel{'s' * (channels != 1)}, {8 * width} bits, {rate} Hz"
            if channels != 1 or width != 2 or not 8_000 <= rate <= 48_000:
                raise ModuleError(
                    f"a sound is ignored: it has {kind}; send one channel, 16 bits and 8,000 to 48,000 Hz"
                )
            samples = file.readframes(round(MAX_DURATION * rate) + 1)
    except (wave.Error, EOFError, OSError):
        raise ModuleError("a sound is ignored: it is not a WAV file, or not of a supported kind") from None
    found = Sound(rate, samples[: len(samples) // 2 * 2])
    if not samples:
        raise ModuleError("a sound is ignored: it is empty")
    if found.duration > MAX_DURATION:
        raise ModuleError(f"a sound is ignored: it is longer than {MAX_DURATION:g} s")
    return found


def save(file: Path, sound: Sound) -> None:
    """Write a WAV file. Raises ModuleError if the file can't be written."""
    try:
        with file.open("wb") as opened:
            _write(opened, sound)
    except OSError as error:
        raise ModuleError(f"{file} cannot be written: {error.strerror}") from None


def _write(where: IO[bytes], sound: Sound) -> None:
    with wave.open(where, "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(sound.rate)
        file.writeframes(sound.samples)
