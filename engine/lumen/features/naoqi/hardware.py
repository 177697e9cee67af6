"""NAOqi's names of the devices of NAO and Pepper. Those of Pepper have not been tested on a robot."""

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
    """Return ALMemory's key of a sensor's value."""
    return _DEVICE.format(f"{name}/Sensor")


@dataclass(frozen=True)
class Hardware:
    """The devices of one kind of robot."""

    touch: Mapping[str, tuple[str, ...]]
    """The devices behind each tactile sensor."""
    sonars: tuple[str, str]
    """The devices of the left and the right sonar."""
    inertial: str
    """The device of the inertial unit."""
    force: tuple[str, ...]
    """The force sensors under the soles."""
    lights: Mapping[str, str]
    """ALLeds' groups by Lumen's groups of lights."""
    breathing: tuple[str, ...]
    """The chains, besides the head, that NAOqi's breathing moves."""
    edge: str
    """The name of the part that leaves the stage first, for messages."""
    reach: float
    """The distance of that part from the robot's position [m]."""
    gets_up: bool
    """True if the robot gets up by itself after a fall."""


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
"""ALLeds' groups. The ears of both robots, and NAO's head, are only blue: they show the blue part of a colour."""

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
        "head": "BrainLeds", "feet": "FeetLeds", "left_foot": "LeftFootLeds", "right_foot": "RightFootLeds",
    },
    breathing=("Arms", "Legs"),
    edge="a foot",
    reach=0.1,
    gets_up=True,
)  # fmt: skip

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
"""Pepper's only sonar that points ahead serves as both the left and the right one."""


def hardware_of(body: Body) -> Hardware:
    """Return Pepper's hardware for a body that drives, else NAO's."""
    return PEPPER if body.roles.base.row.drives else NAO
