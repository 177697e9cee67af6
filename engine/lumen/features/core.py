"""What every project needs, and what has no feature of its own yet."""

from lumen.feature import Feature

FEATURE = Feature(name="core")
