"""A voice for texts on the bus."""

from lumen.feature import Feature, ModuleRow

FEATURE = Feature(
    name="voice",
    modules={"voice": ModuleRow("lumen.modules.voice:Voice")},
    voices={"espeak": "lumen.app.voice:Speaker"},
)
