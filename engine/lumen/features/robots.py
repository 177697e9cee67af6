"""The robots without a body: one that only records its commands, one in a process of its own, and none."""

from lumen.feature import Feature, RobotRow

FEATURE = Feature(
    name="robots",
    robots={
        "recording": RobotRow("lumen.run.robots.recorded:set_up", bounded=True),
        "remote": RobotRow(),
        "none": RobotRow("lumen.run.robots.absent:set_up", real_time=True, bounded=True),
    },
)
