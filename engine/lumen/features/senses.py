"""The five senses of Lumen Server."""

from lumen.feature import Feature, SenseRow

_CODEC = "lumen.robot.sense_codec"

FEATURE = Feature(
    name="senses",
    senses={
        "image": SenseRow("the images from the robot's camera"),
        "joint": SenseRow(
            "the angles of the robot's joints; `track` needs this route",
            f"{_CODEC}:encode_joints",
            f"{_CODEC}:decode_joints",
        ),
        "sonar": SenseRow("the distances to the nearest obstacles", f"{_CODEC}:encode_sonar", f"{_CODEC}:decode_sonar"),
        "tactile": SenseRow(
            "the touch sensors that are pressed", f"{_CODEC}:encode_tactile", f"{_CODEC}:decode_tactile"
        ),
        "battery": SenseRow(
            "the charge of the robot's battery", f"{_CODEC}:encode_battery", f"{_CODEC}:decode_battery"
        ),
    },
)
