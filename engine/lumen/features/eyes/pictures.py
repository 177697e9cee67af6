"""Frames from messages, checked before use."""

import base64
import binascii
from io import BytesIO
from typing import TYPE_CHECKING, Any, NamedTuple

from lumen.errors import ModuleError
from lumen.language.data_url import DataUrl

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    Grey = NDArray[np.uint8]
    """A grey image, Shape (height, width)."""

MIN_PICTURE_SIZE, MAX_PICTURE_SIZE = 32, 4096
"""The range of a picture's width and height [px]: smaller pictures show nothing usable, larger ones take too long."""


class Frame(NamedTuple):
    """A grey picture and its time on the robot's clock [s]; the time is None if unknown."""

    grey: "Grey"
    time: float | None


def frame_of(body: Any) -> Frame:
    """Return the frame in an image message. Raises ModuleError if the image is invalid or its size is out of range."""
    url = body.get("contentUrl") if isinstance(body, dict) else None
    if not isinstance(url, str) or not url.startswith("data:image/"):
        raise ModuleError("an image is ignored: its `contentUrl` must begin with `data:image/`")
    try:
        data = url.data if isinstance(url, DataUrl) else base64.b64decode(url.partition(",")[2], validate=True)
    except (binascii.Error, ValueError):
        raise ModuleError("an image is ignored: its `contentUrl` is not base64") from None
    time = body.get("time")
    return Frame(_grey(data), float(time) if isinstance(time, int | float) else None)


def _grey(data: bytes) -> "Grey":
    import numpy as np
    from PIL import Image

    try:
        with Image.open(BytesIO(data)) as picture:
            check_size(*picture.size)
            grey: Grey = np.asarray(picture.convert("L"))
    except ModuleError:
        raise
    except Exception as error:  # Pillow's decoders raise exceptions of many types
        raise ModuleError(f"an image is ignored: it cannot be read ({type(error).__name__})") from None
    return grey


def check_size(width: int, height: int) -> None:
    """Raise ModuleError if the size of a picture [px] is out of range."""
    if not (MIN_PICTURE_SIZE <= width <= MAX_PICTURE_SIZE and MIN_PICTURE_SIZE <= height <= MAX_PICTURE_SIZE):
        bounds = f"between {MIN_PICTURE_SIZE} and {MAX_PICTURE_SIZE}"
        raise ModuleError(f"an image is {width} x {height} px: its width and height must be {bounds}")
