"""The manifest of the stranger's feature."""

from lumen.feature import Feature

FEATURE = Feature(
    name="stranger",
    rules=("lumen_stranger.rules:check",),
    pages=("lumen_stranger.pages",),
    fixes={"small-name": "lumen_stranger.rules:enlarged"},
)
