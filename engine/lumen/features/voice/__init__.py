"""A voice for texts on the bus."""

from lumen.feature import Feature, ModuleRow

FEATURE = Feature(
    name="voice",
    modules={"voice": ModuleRow("lumen.features.voice.module:Voice")},
    voices={"espeak": "lumen.features.voice.speaker:Speaker"},
)
