"""The pages in a browser that show an exhibition and control it."""

from lumen.feature import Feature

FEATURE = Feature(
    name="console",
    rules=("lumen.rules.console:check",),
)
