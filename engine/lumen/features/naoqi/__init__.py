"""A real NAO or Pepper."""

from lumen.feature import Feature, RobotOption, RobotRow

URL = RobotOption("url", "URL", "with --robot naoqi: the robot's address (default: tcp://nao.local:9559)")

FEATURE = Feature(
    name="naoqi",
    extras=("naoqi",),
    robots={
        "naoqi": RobotRow(
            "lumen.features.naoqi.set_up:set_up",
            "lumen.features.naoqi.set_up:set_up_house",
            real_time=True,
            bounded=True,
            options=(URL,),
        )
    },
)
