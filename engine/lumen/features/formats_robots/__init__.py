"""Models of robots from other tools."""

from lumen.feature import Feature

FEATURE = Feature(
    name="formats_robots",
    format_tables={
        "URDF": "lumen.formats.robot_models.urdf:KNOWN",
        "MJCF": "lumen.formats.robot_models.mjcf_known:KNOWN",
    },
)
