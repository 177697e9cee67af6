"""Texts as sound, spoken by espeak-ng; on the bus, the text-to-speech module."""

from lumen.modules.voice.espeak import Espeak, espeak
from lumen.modules.voice.voice import Voice

__all__ = ["Espeak", "Voice", "espeak"]
