"""Lamps, screens and sounds of a hall."""

from lumen.feature import Feature

FEATURE = Feature(
    name="show",
    rules=("lumen.rules.show:check",),
)
