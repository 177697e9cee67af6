"""Models of robots from other tools."""

from lumen.feature import Feature

FEATURE = Feature(
    name="formats_robots",
    format_tables={
        "URDF": "lumen.features.formats_robots.urdf:KNOWN",
        "MJCF": "lumen.features.formats_robots.mjcf_known:KNOWN",
    },
)
