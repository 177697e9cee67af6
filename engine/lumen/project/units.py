"""Durations, angles and lengths as people write them, in SI."""

from collections.abc import Mapping
from math import pi

from lumen.language.diagnostics import ERROR, Code
from lumen.language.durations import seconds

__all__ = ["ANGLES", "BAD_DURATION", "LENGTHS", "seconds"]

BAD_DURATION = Code("bad-duration", "shape", ERROR, "a duration can't be read")


ANGLES: Mapping[str, float] = {"rad": 1.0, "deg": pi / 180}
LENGTHS: Mapping[str, float] = {"m": 1.0, "cm": 0.01, "mm": 0.001}
