"""The robot under physics."""

from lumen.feature import Feature, Section

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
)
