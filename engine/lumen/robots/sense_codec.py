"""The five senses as the JSON bodies of 2015, and `time` [s], the robot's clock, which is ours."""

import base64
import wave
from collections.abc import Mapping
from io import BytesIO
from typing import TYPE_CHECKING, Any

from lumen.language.routes import Size
from lumen.ports import Battery, Image, Joints, Sonar, Tactile

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

JPEG_QUALITY = 80
RECORDING_RATE = 16_000
"""Samples of a recording a second."""


def body_of(reading: Joints | Sonar | Tactile | Battery) -> dict[str, Any]:
    """The body of a reading that is numbers already; angles in [rad], distances in [m], charge in [%]."""
    match reading:
        case Joints(time, names, angles, stiffness):
            body = {"name": list(names), "angle": list(angles), "stiffness": list(stiffness), "time": time}
            felt = {"temperature": list(reading.temperature), "inertial": reading.inertial, "fsr": reading.fsr}
            return body | {name: dict(v) if isinstance(v, Mapping) else v for name, v in felt.items() if v}
        case Sonar(time, left, right):
            return {"rightSensor": right, "leftSensor": left, "time": time}
        case Tactile(time, names, values):
            return {"name": list(names), "value": list(values), "time": time}
        case Battery(time, percentage, plugged, charging):
            return {"percentage": percentage, "isPlugged": plugged, "isCharging": charging, "time": time}


def image_body(image: Image, number: int, date: str, size: Size | None = None) -> dict[str, Any]:
    """The body of a frame of that size: `number` counts frames, `date` is when it was taken (ISO 8601).

    Renders and compresses, so call it from the thread that owns the camera. Raises RobotError where the robot can't
    give a picture.
    """
    jpeg = _jpeg(image.pixels(size) if size else image.pixels())
    return {
        "name": str(number),
        "contentType": "image/jpeg",
        "contentSize": len(jpeg),
        "uploadDate": date,
        "dateCreated": date,
        "dateModified": date,
        "datePublished": date,
        "contentUrl": "data:image/jpeg;base64," + base64.b64encode(jpeg).decode("ascii"),
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
