"""The robot under physics."""

from lumen.feature import Feature, RobotRow, Section

FEATURE = Feature(
    name="simulation",
    sections={
        "imperfections": Section(
            read="lumen.loading.imperfections:read_imperfections",
            title="the robot's imperfections",
            risk="restart",
            of_house=True,
        )
    },
    extras=("simulation",),
    robots={
        "simulation": RobotRow(
            "lumen.app.robots.simulated:set_up", "lumen.app.robots.simulated:set_up_house", bounded=True
        )
    },
)
