"""Texts as sound, spoken by espeak-ng; on the bus, the text-to-speech module."""

from lumen.features.voice.espeak_voice import Espeak, espeak
from lumen.features.voice.voice import Voice

__all__ = ["Espeak", "Voice", "espeak"]
