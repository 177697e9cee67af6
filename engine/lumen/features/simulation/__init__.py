"""The robot under physics."""

from lumen.feature import BaseRow, Feature, RobotRow, Section

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
    bases={
        "biped": BaseRow("lumen.features.simulation.biped:Biped", "a biped", legs=True),
        "wheels": BaseRow("lumen.features.simulation.wheels:Wheels", "a base on wheels", drives=True, wheels=True),
        "fixed": BaseRow("lumen.features.simulation.fixed:Fixed", "a base that is built in"),
    },
    robots={
        "simulation": RobotRow(
            "lumen.features.simulation.set_up:set_up", "lumen.features.simulation.set_up:set_up_house", bounded=True
        )
    },
)
