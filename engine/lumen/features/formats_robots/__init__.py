"""Import of other tools' robot models."""

from lumen.feature import Feature, Importer

_ROBOT = Importer(
    "robot", "lumen.features.formats_robots.importing:robot_body", "lumen.features.formats_robots.reading:begins_robot"
)

FEATURE = Feature(
    name="formats_robots",
    importers={".urdf": _ROBOT, ".mjcf": _ROBOT},
    format_tables={
        "URDF": "lumen.features.formats_robots.urdf:KNOWN",
        "MJCF": "lumen.features.formats_robots.mjcf_known:KNOWN",
    },
)
