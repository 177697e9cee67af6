"""Converts sounds to another sampling rate."""

from lumen.run.sound import Sound


def resampled(sound: Sound, rate: int) -> Sound:
    """Return the sound at the sampling rate `rate` [Hz], interpolated linearly between its samples."""
    if sound.rate == rate:
        return sound
    import numpy as np

    samples = np.frombuffer(sound.samples, "<i2")
    count = max(1, round(len(samples) * rate / sound.rate))
    places = np.linspace(0.0, len(samples) - 1.0, count)
    return Sound(rate, np.interp(places, np.arange(len(samples)), samples).astype("<i2").tobytes())
