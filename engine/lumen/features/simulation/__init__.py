"""The robot under physics."""

from lumen.feature import Feature, RobotRow, Section

FEATURE = Feature(
    name="simulation",
    sections={
        "imperfections": Section(
            read="lumen.features.simulation.reading:read_imperfections",
            title="the robot's imperfections",
            risk="restart",
            of_house=True,
        )
    },
    extras=("simulation",),
    robots={
        "simulation": RobotRow(
            "lumen.features.simulation.set_up:set_up", "lumen.features.simulation.set_up:set_up_house", bounded=True
        )
    },
)
