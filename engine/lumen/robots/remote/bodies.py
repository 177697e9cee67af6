"""Commands as the bodies that Lumen Server takes, and the bodies of senses as readings."""

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from typing import Any, assert_never

from lumen.language.commands import Look, Move, Posture, Rest, Say, Stop, Wake, Walk
from lumen.ports import Aim, Battery, Joints, Perform, Reading, Record, RobotCommand, Sense, Sonar, Tactile
from lumen.robots.motion_codec import encode_motion


def body_of(command: RobotCommand) -> dict[str, Any]:
    """What is sent for a command, spelt as in 2015 where 2015 had it."""
    match command:
        case Say(text, language):
            return _body("texttospeech", "say", text=text, language=language)
        case Perform(motion):
            return _body("motion", "perform", motion=encode_motion(motion))
        case Posture(name, speed):
            return _body("posture", "goToPosture", postureName=name, speed=speed)
        case Walk(x, y, theta):
            return _body("motion", "moveTo", x=x, y=y, tetha=theta)
        case Move(vx, vy, vtheta):
            return _body("motion", "move", x=vx, y=vy, tetha=vtheta)
        case Look(yaw, pitch):
            return _body("motion", "look", yaw=yaw, pitch=pitch)
        case Aim(angles, speed):
            return _body("motion", "setAngles", jointNames=list(angles), angles=list(angles.values()), speed=speed)
        case Record(name, duration):
            return _body("audiodevice", "record", recordingName=name, duration=duration)
        case Stop(what):
            return _body("motion", "stop", what=what)
        case Rest():
            return _body("motion", "rest")
        case Wake():
            return _body("motion", "wakeUp")
        case _:
            assert_never(command)


def _body(kind: str, method: str, **parameter: Any) -> dict[str, Any]:
    return {"type": kind, "method": method, "parameter": parameter}


def reading_of(sense: Sense, body: Any, names: Sequence[str]) -> Reading | None:
    """The reading in a body of that sense; None where it is none, or of another body than the one with these joints.

    Of images it is always None: pictures are for other modules.
    """
    if not isinstance(body, Mapping):
        return None
    try:
        time = float(body.get("time", 0.0))
        match sense:
            case Sense.JOINT:
                known, angles = tuple(map(str, body["name"])), tuple(map(float, body["angle"]))
                stiffness = tuple(map(float, body["stiffness"]))
                whole = known == tuple(names) and len(angles) == len(stiffness) == len(known)
                felt = _felt(body, len(known))
                return Joints(time, known, angles, stiffness, *felt) if whole else None
            case Sense.SONAR:
                return Sonar(time, float(body["leftSensor"]), float(body["rightSensor"]))
            case Sense.TACTILE:
                return Tactile(time, tuple(map(str, body["name"])), tuple(map(int, body["value"])))
            case Sense.BATTERY:
                return Battery(
                    time,
                    int(body["percentage"]),
                    plugged=bool(body["isPlugged"]),
                    charging=bool(body["isCharging"]),
                )
            case Sense.IMAGE:
                return None
    except (KeyError, TypeError, ValueError, OverflowError):
        return None


def _felt(body: Mapping[str, Any], count: int) -> tuple[tuple[float, ...], dict[str, float], dict[str, float]]:
    """What else the robot feels of itself: motors' temperatures, inertial unit, soles; empty where nothing is said."""
    temperature = tuple(map(float, body.get("temperature", ())))
    inertial, fsr = ({str(k): float(v) for k, v in dict(body.get(name, {})).items()} for name in ("inertial", "fsr"))
    return temperature if len(temperature) == count else (), inertial, fsr


def visitor_body(visitor: Any) -> dict[str, Any]:
    """The body that puts this visitor into the hall."""
    return {"visitor": None if visitor is None else asdict(visitor)}
