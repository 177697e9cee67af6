"""Readings of the senses as the JSON bodies of 2015; Lumen added `time` [s], on the robot's clock."""

import base64
import wave
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from io import BytesIO
from typing import TYPE_CHECKING, Any

from lumen.errors import LumenError
from lumen.feature import SenseRow, distribution_of, owner, table
from lumen.language.data_url import DataUrl
from lumen.language.routes import Size
from lumen.ports import Battery, Image, Joints, OtherReading, Sonar, Tactile, Whereabouts
from lumen.project.broken_features import blaming, called, faulty, resolved, shown

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

NO_READING = KeyError, TypeError, ValueError, OverflowError
"""The errors of a decoder that received a body without a reading."""
JPEG_QUALITY = 80
RECORDING_RATE = 16_000
"""The number of samples per second of a recording."""


def encode_reading(sense: str, reading: OtherReading) -> dict[str, Any]:
    """Return the body of a reading of any sense but images.

    Raises LumenError with the name of the installed package if its code is faulty.
    """
    feature, where = owner("senses", sense), table("senses")[sense].encode
    body: dict[str, Any] = called(feature, where, reading)
    if distribution_of(feature) and not isinstance(body, dict):
        raise faulty(feature, f"`{where}` returned {shown(body)} instead of the body of a message")
    return body


def decode_reading(sense: str, body: Any, names: Sequence[str]) -> OtherReading | None:
    """Return the reading in a body of that sense; None if the body lacks it, or is of a robot with other joints.

    For images it is always None, because they are for other modules. Raises LumenError with the name of the installed
    package if its code is faulty.
    """
    row: SenseRow = table("senses")[sense]
    if not isinstance(body, Mapping) or not row.decode:
        return None
    feature = owner("senses", sense)
    decode: Callable[[Mapping[str, Any], Sequence[str]], OtherReading | None] = resolved(feature, row.decode)
    with suppress(*NO_READING), blaming(feature, row.decode, LumenError, *NO_READING):
        reading = decode(body, names)
        if not (reading is None or isinstance(reading, OtherReading)):
            raise faulty(feature, f"`{row.decode}` returned {shown(reading)} instead of a reading or None")
        return reading
    return None


def encode_joints(reading: Joints) -> dict[str, Any]:
    """Return the body of a reading of the joints; angles are in [rad]."""
    body = {
        "name": list(reading.names),
        "angle": list(reading.angles),
        "stiffness": list(reading.stiffness),
        "time": reading.time,
    }
    felt: dict[str, Any] = {"temperature": list(reading.temperature)}
    felt |= {"inertial": reading.inertial, "fsr": reading.fsr, "life": reading.life}
    if reading.position:
        felt["position"] = reading.position._asdict()
    return body | {name: dict(v) if isinstance(v, Mapping) else v for name, v in felt.items() if v}


def decode_joints(body: Mapping[str, Any], names: Sequence[str]) -> Joints | None:
    time, known, angles = _time(body), tuple(map(str, body["name"])), tuple(map(float, body["angle"]))
    stiffness = tuple(map(float, body["stiffness"]))
    whole = known == tuple(names) and len(angles) == len(stiffness) == len(known)
    felt = _felt(body, len(known))
    life = _named(body, "life")
    return Joints(time, known, angles, stiffness, *felt, _position(body), life) if whole else None


def encode_sonar(reading: Sonar) -> dict[str, Any]:
    """Return the body of a reading of the sonars; distances are in [m]."""
    return {"rightSensor": reading.right, "leftSensor": reading.left, "time": reading.time}


def decode_sonar(body: Mapping[str, Any], names: Sequence[str]) -> Sonar:
    return Sonar(_time(body), float(body["leftSensor"]), float(body["rightSensor"]))


def encode_tactile(reading: Tactile) -> dict[str, Any]:
    return {"name": list(reading.names), "value": list(reading.values), "time": reading.time}


def decode_tactile(body: Mapping[str, Any], names: Sequence[str]) -> Tactile:
    return Tactile(_time(body), tuple(map(str, body["name"])), tuple(map(int, body["value"])))


def encode_battery(reading: Battery) -> dict[str, Any]:
    """Return the body of a reading of the battery; the charge is in [%]."""
    return {
        "percentage": reading.percentage,
        "isPlugged": reading.plugged,
        "isCharging": reading.charging,
        "time": reading.time,
    }


def decode_battery(body: Mapping[str, Any], names: Sequence[str]) -> Battery:
    return Battery(
        _time(body), int(body["percentage"]), plugged=bool(body["isPlugged"]), charging=bool(body["isCharging"])
    )


def _time(body: Mapping[str, Any]) -> float:
    return float(body.get("time", 0.0))


def _felt(body: Mapping[str, Any], count: int) -> tuple[tuple[float, ...], dict[str, float], dict[str, float]]:
    """Return the robot's other measurements: motors' temperatures, inertial unit, soles; empty if they are missing."""
    temperature = tuple(map(float, body.get("temperature", ())))
    return temperature if len(temperature) == count else (), _named(body, "inertial"), _named(body, "fsr")


def _named(body: Mapping[str, Any], key: str) -> dict[str, float]:
    """Return the numbers under that key, by their names; empty if they are missing."""
    return {str(name): float(value) for name, value in dict(body.get(key, {})).items()}


def _position(body: Mapping[str, Any]) -> Whereabouts | None:
    """Return the robot's estimate of its own place; None if it is missing."""
    said = body.get("position")
    return Whereabouts(*(float(said[name]) for name in Whereabouts._fields)) if isinstance(said, Mapping) else None


def image_body(image: Image, number: int, date: str, size: Size | None = None, camera: str = "") -> dict[str, Any]:
    """Return the body of a message with an image, of that size if one is given.

    `number` counts frames, `date` is the time of the frame (ISO 8601), `camera` the name of its camera. Renders and
    compresses, so call it from the thread that owns the camera. Raises RobotError if the robot cannot give an image.
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
    """Return the body of a recording, a WAV: `samples` are 16 bits, little-endian, one channel, at RECORDING_RATE."""
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
