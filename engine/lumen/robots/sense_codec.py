"""Readings of the senses as the JSON bodies of 2015, and `time` [s], the robot's clock, which is ours."""

import base64
import wave
from collections.abc import Mapping, Sequence
from io import BytesIO
from typing import TYPE_CHECKING, Any, assert_never

from lumen.language.data_url import DataUrl
from lumen.language.routes import Size
from lumen.ports import Battery, Image, Joints, NumericReading, Reading, Sense, Sonar, Tactile, Whereabouts

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

JPEG_QUALITY = 80
RECORDING_RATE = 16_000
"""Samples of a recording a second."""


def encode_reading(reading: NumericReading) -> dict[str, Any]:
    """The body of a reading that is numbers already; angles in [rad], distances in [m], charge in [%]."""
    match reading:
        case Joints(time, names, angles, stiffness):
            body = {"name": list(names), "angle": list(angles), "stiffness": list(stiffness), "time": time}
            felt: dict[str, Any] = {"temperature": list(reading.temperature)}
            felt |= {"inertial": reading.inertial, "fsr": reading.fsr, "life": reading.life}
            if reading.position:
                felt["position"] = reading.position._asdict()
            return body | {name: dict(v) if isinstance(v, Mapping) else v for name, v in felt.items() if v}
        case Sonar(time, left, right):
            return {"rightSensor": right, "leftSensor": left, "time": time}
        case Tactile(time, names, values):
            return {"name": list(names), "value": list(values), "time": time}
        case Battery(time, percentage, plugged, charging):
            return {"percentage": percentage, "isPlugged": plugged, "isCharging": charging, "time": time}
        case _:
            assert_never(reading)


def decode_reading(sense: Sense, body: Any, names: Sequence[str]) -> Reading | None:
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
                life = _named(body, "life")
                return Joints(time, known, angles, stiffness, *felt, _position(body), life) if whole else None
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
            case _:
                assert_never(sense)
    except (KeyError, TypeError, ValueError, OverflowError):
        return None


def _felt(body: Mapping[str, Any], count: int) -> tuple[tuple[float, ...], dict[str, float], dict[str, float]]:
    """What else the robot feels of itself: motors' temperatures, inertial unit, soles; empty where nothing is said."""
    temperature = tuple(map(float, body.get("temperature", ())))
    return temperature if len(temperature) == count else (), _named(body, "inertial"), _named(body, "fsr")


def _named(body: Mapping[str, Any], key: str) -> dict[str, float]:
    """The numbers under that key, by their names; empty where nothing is said."""
    return {str(name): float(value) for name, value in dict(body.get(key, {})).items()}


def _position(body: Mapping[str, Any]) -> Whereabouts | None:
    """Where the robot believes to be; None where it does not say."""
    said = body.get("position")
    return Whereabouts(*(float(said[name]) for name in Whereabouts._fields)) if isinstance(said, Mapping) else None


def image_body(image: Image, number: int, date: str, size: Size | None = None, camera: str = "") -> dict[str, Any]:
    """The body of a frame of that size: `number` counts frames, `date` is when it was taken (ISO 8601), `camera` by
    which camera.

    Renders and compresses, so call it from the thread that owns the camera. Raises RobotError where the robot can't
    give a picture.
    """
    pixels = image.pixels(size) if size else image.pixels()
    jpeg, (height, width) = _jpeg(pixels), pixels.shape[:2]
    return {
        "name": str(number),
        "contentType": "image/jpeg",
        "contentSize": len(jpeg),
        "uploadDate": date,
        "dateCreated": date,
        "dateModified": date,
        "datePublished": date,
        "contentUrl": DataUrl(jpeg),
        "width": width,
        "height": height,
        "camera": camera,
        "time": image.time,
    }


def recording_body(name: str, samples: bytes) -> dict[str, Any]:
    """The body of a recording: `samples` of 16 bits, little-endian, one channel, `RATE` a second, as a WAV."""
    buffer = BytesIO()
    with wave.open(buffer, "wb") as file:
        file.setnchannels(1)
        file.setsampwidth(2)
        file.setframerate(RECORDING_RATE)
        file.writeframes(samples)
    return {"name": name, "content": base64.b64encode(buffer.getvalue()).decode("ascii")}


def _jpeg(pixels: "NDArray[np.uint8]") -> bytes:
    from PIL import Image as Picture  # 0.1 s to import, and only a robot with a camera needs it

    buffer = BytesIO()
    Picture.fromarray(pixels).save(buffer, "JPEG", quality=JPEG_QUALITY)
    return buffer.getvalue()
