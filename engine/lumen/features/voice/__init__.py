"""Text to speech for the bus and for the simulated robot."""

from lumen.feature import Feature, ModuleRow

FEATURE = Feature(
    name="voice",
    modules={"voice": ModuleRow("lumen.features.voice.module:Voice")},
    voices={"espeak": "lumen.features.voice.speaker:Speaker"},
)
