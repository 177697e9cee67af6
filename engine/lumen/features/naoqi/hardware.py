"""What NAOqi calls the devices of its two robots: NAO, and Pepper on its wheels. Pepper's names are from memory."""

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
    """ALMemory's key of what a sensor measures."""
    return _DEVICE.format(f"{name}/Sensor")


@dataclass(frozen=True)
class Hardware:
    """The devices of one kind of robot.

    `touch` are those behind each tactile sensor, `sonars` those that the left and the right one are read from, `force`
    those under the soles. `lights` maps our groups of lights to those of ALLeds. `breathing` are the chains that
    NAOqi's breathing moves beside the head, which is ours. `edge` is what leaves the stage first, as far as `reach`
    from the robot's place [m]. One that `gets_up` does so after a fall by itself.
    """

    touch: Mapping[str, tuple[str, ...]]
    sonars: tuple[str, str]
    inertial: str
    force: tuple[str, ...]
    lights: Mapping[str, str]
    breathing: tuple[str, ...]
    edge: str
    reach: float
    gets_up: bool


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
"""ALLeds' groups. Ears of both are blue only, as is NAO's head, and show of a colour how much blue is in it."""

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
"""Its one sonar that looks ahead is both the left and the right one of our message."""


def hardware_of(body: Body) -> Hardware:
    """Return Pepper's hardware for a body that drives, else NAO's."""
    return PEPPER if body.roles.base.row.drives else NAO
