"""A picture as a text for JSON that still holds its bytes."""

import base64
from typing import Self

from lumen.language.routes import JPEG_TYPE

JPEG_URL = f"data:{JPEG_TYPE};base64,"


class DataUrl(str):
    """The text `data:image/jpeg;base64,…` of a JPEG, which also keeps the picture's bytes, in `data`."""

    __slots__ = ("data",)

    data: bytes

    def __new__(cls, data: bytes) -> Self:
        """Return the text of these bytes."""
        text = super().__new__(cls, JPEG_URL + base64.b64encode(data).decode("ascii"))
        text.data = data
        return text
