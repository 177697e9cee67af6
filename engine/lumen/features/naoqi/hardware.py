"""NAOqi's device names for NAO and Pepper. Pepper's names have not been tested on a robot."""

from collections.abc import Mapping
from dataclasses import dataclass

from lumen.language.robots import Body

_DEVICE = "Device/SubDeviceList/{}/Value"

CHARGE, PLUGGED, CHARGING = (
    _DEVICE.format("Battery/Charge/Sensor"),
    "BatteryPowerPluggedChanged",
    "BatteryChargingFlagChanged",
)

INERTIAL = tuple(f"{kind}{axis}" for kind in ("Angle", "Gyroscope", "Accelerometer") for axis in "XYZ")
FORCE_SENSORS = tuple(
    f"{foot}/FSR/{where}"
    for foot in ("LFoot", "RFoot")
    for where in ("FrontLeft", "FrontRight", "RearLeft", "RearRight", "TotalWeight")
)


def device(name: str) -> str:
    """Return ALMemory's key for a sensor's value."""
    return _DEVICE.format(f"{name}/Sensor")


@dataclass(frozen=True)
class Hardware:
    """The devices and abilities of one robot type."""

    touch: Mapping[str, tuple[str, ...]]
    """The devices of each tactile sensor."""
    sonars: tuple[str, str]
    """The devices of the left and right sonars."""
    inertial: str
    """The inertial unit's device."""
    force: tuple[str, ...]
    """The force sensors under the soles."""
    lights: Mapping[str, str]
    """ALLeds' groups by Lumen's light names."""
    breathing: tuple[str, ...]
    """The joint chains, besides the head, that NAOqi's breathing moves."""
    edge: str
    """The body part that leaves the stage first, as messages name it."""
    reach: float
    """The distance from the robot's position to `edge` [m]."""
    gets_up: bool
    """Whether the robot can get up by itself after a fall."""


_HEAD_TOUCH = {
    "ChestButton": ("ChestBoard/Button",),
    "FrontTactil": ("Head/Touch/Front",),
    "MiddleTactil": ("Head/Touch/Middle",),
    "RearTactil": ("Head/Touch/Rear",),
    "HandRightBack": ("RHand/Touch/Back",),
    "HandLeftBack": ("LHand/Touch/Back",),
}

_FACE_LIGHTS = {
    "eyes": "FaceLeds", "left_eye": "LeftFaceLeds", "right_eye": "RightFaceLeds",
    "ears": "EarLeds", "left_ear": "LeftEarLeds", "right_ear": "RightEarLeds",
    "chest": "ChestLeds",
}  # fmt: skip
"""ALLeds' groups for both robots. The ears, and NAO's head, have only blue LEDs, which show a colour's blue value."""

NAO = Hardware(
    touch={
        **_HEAD_TOUCH,
        "RightBumper": ("RFoot/Bumper/Left", "RFoot/Bumper/Right"),
        "LeftBumper": ("LFoot/Bumper/Left", "LFoot/Bumper/Right"),
        "HandRightLeft": ("RHand/Touch/Left",),
        "HandRightRight": ("RHand/Touch/Right",),
        "HandLeftLeft": ("LHand/Touch/Left",),
        "HandLeftRight": ("LHand/Touch/Right",),
    },
    sonars=("US/Left", "US/Right"),
    inertial="InertialSensor",
    force=FORCE_SENSORS,
    lights={
        **_FACE_LIGHTS,
        "head": "BrainLeds",
        "feet": "FeetLeds",
        "left_foot": "LeftFootLeds",
        "right_foot": "RightFootLeds",
    },
    breathing=("Arms", "Legs"),
    edge="a foot",
    reach=0.1,
    gets_up=True,
)

PEPPER = Hardware(
    touch={
        **_HEAD_TOUCH,
        "RightBumper": ("Platform/FrontRight/Bumper",),
        "LeftBumper": ("Platform/FrontLeft/Bumper",),
        "BackBumper": ("Platform/Back/Bumper",),
    },
    sonars=("Platform/Front/Sonar", "Platform/Front/Sonar"),
    inertial="InertialSensorBase",
    force=(),
    lights=_FACE_LIGHTS,
    breathing=("Arms",),
    edge="the base",
    reach=0.25,
    gets_up=False,
)
"""Pepper's only forward sonar is used for both left and right."""


def hardware_of(body: Body) -> Hardware:
    """Return Pepper's hardware for a body that drives, else NAO's."""
    return PEPPER if body.roles.base.row.drives else NAO
