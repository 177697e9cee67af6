"""A picture as the text that JSON has room for, which still knows its bytes."""

import base64
from typing import Self

from lumen.language.routes import JPEG_TYPE

JPEG_URL = f"data:{JPEG_TYPE};base64,"


class DataUrl(str):
    """`data:image/jpeg;base64,…` of a JPEG: a text like any other; who needs the bytes has them in `data`."""

    __slots__ = ("data",)

    data: bytes

    def __new__(cls, data: bytes) -> Self:
        """The text of these bytes."""
        text = super().__new__(cls, JPEG_URL + base64.b64encode(data).decode("ascii"))
        text.data = data
        return text
