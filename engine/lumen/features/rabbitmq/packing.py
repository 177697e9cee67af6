"""Images and joints as bytes on a broker: the JPEG itself, or angles as floats; other fields become headers.

Subscribers receive a body of the same form as from JSON.
"""

import binascii
import json
import math
from array import array
from collections.abc import Mapping
from sys import byteorder
from typing import Any, NamedTuple

from lumen.bus.bodies import MAX_BODY_BYTES, copied
from lumen.errors import BadMessageError
from lumen.features.rabbitmq.properties import CAUSE_HEADER
from lumen.language.data_url import JPEG_URL, DataUrl
from lumen.language.routes import FLOATS_TYPE, JPEG_TYPE

Header = str | int
"""The types of a header's value. pika writes no floats, so times are texts."""
TIME = "time"

_SAME = {"dateModified": "dateCreated", "datePublished": "uploadDate"}
"""The image fields that only repeat another field, each with that field's name."""
_LISTS = ("angle", "stiffness", "temperature")
"""The lists in a body of joints, with one number for each joint; a body has at least two of the lists."""


class PackedBody(NamedTuple):
    """A body's bytes, their media type, and its remaining fields."""

    data: bytes
    content_type: str
    headers: dict[str, Header]


def packed(body: Any, content_type: str) -> PackedBody | None:
    """Return the body in the form of `content_type`; None if that form can't represent it.

    JPEG_TYPE represents an image whose other fields are texts or integers, FLOATS_TYPE joints. The limit of both is
    MAX_BODY_BYTES.
    """
    if not isinstance(body, Mapping):
        return None
    found = _image(body) if content_type == JPEG_TYPE else _joints(body) if content_type == FLOATS_TYPE else None
    return found if found and len(found.data) <= MAX_BODY_BYTES else None


def unpacked(data: bytes, content_type: str, headers: Mapping[str, Header]) -> dict[str, Any]:
    """Return the body from its packed form. Raises ValueError with the reason if that form is invalid."""
    if len(data) > MAX_BODY_BYTES:
        raise ValueError(f"it has more than {MAX_BODY_BYTES:,} bytes")
    if content_type == JPEG_TYPE:
        return _image_again(data, headers)
    try:
        return dict(copied(_joints_again(data, headers)))
    except BadMessageError as error:
        raise ValueError(str(error)) from error


def _image(body: Mapping[str, Any]) -> PackedBody | None:
    url, said = body.get("contentUrl"), {k: v for k, v in body.items() if k not in ("contentUrl", "contentType")}
    if not isinstance(url, str) or not url.startswith(JPEG_URL) or body.get("contentType") != JPEG_TYPE:
        return None
    try:
        data = url.data if isinstance(url, DataUrl) else binascii.a2b_base64(url[len(JPEG_URL) :], strict_mode=True)
    except ValueError:
        return None
    doubled = all(said.pop(name, None) == said.get(other) for name, other in _SAME.items())
    sized = said.pop("contentSize", None) == len(data)
    if TIME in said:
        said[TIME] = repr(float(said[TIME]))
    plain = all(isinstance(value, Header) for value in said.values())
    return PackedBody(data, JPEG_TYPE, said) if doubled and sized and plain else None


def _image_again(data: bytes, headers: Mapping[str, Header]) -> dict[str, Any]:
    if not data.startswith(b"\xff\xd8"):
        raise ValueError("it is not a JPEG")
    said = {name: headers[other] for name, other in _SAME.items() if other in headers}
    own = {"contentType": JPEG_TYPE, "contentSize": len(data), "contentUrl": DataUrl(data)}
    rest = {k: v for k, v in headers.items() if not k.startswith("x-") and k not in (TIME, CAUSE_HEADER)}
    return {"name": "", **rest, **said, **own, **_timed(headers)}


def _joints(body: Mapping[str, Any]) -> PackedBody | None:
    names, lists = body.get("name"), [body[name] for name in _LISTS if name in body]
    if not isinstance(names, list) or not all(isinstance(name, str) and "," not in name for name in names):
        return None
    if not names or len(lists) < 2 or not all(isinstance(one, list) and len(one) == len(names) for one in lists):
        return None
    try:
        numbers = array("f", [number for one in lists for number in one])
    except (TypeError, OverflowError):
        return None
    if byteorder == "big":
        numbers.byteswap()
    headers: dict[str, Header] = {"names": ",".join(names), "lists": ",".join(n for n in _LISTS if n in body)}
    if TIME in body:
        headers[TIME] = repr(float(body[TIME]))
    if more := {key: value for key, value in body.items() if key not in ("name", TIME, *_LISTS)}:
        headers["more"] = json.dumps(more, separators=(",", ":"))
    return PackedBody(numbers.tobytes(), FLOATS_TYPE, headers)


def _joints_again(data: bytes, headers: Mapping[str, Header]) -> dict[str, Any]:
    names, lists = (str(headers.get(key, "")).split(",") for key in ("names", "lists"))
    if len(data) != 4 * len(names) * len(lists) or not {*lists} <= {*_LISTS}:
        raise ValueError("its headers `names` and `lists` do not match its numbers")
    numbers = array("f", data)
    if byteorder == "big":
        numbers.byteswap()
    rows = {name: numbers[i * len(names) : (i + 1) * len(names)].tolist() for i, name in enumerate(lists)}
    try:
        more = json.loads(str(headers.get("more", "{}")))
    except (ValueError, RecursionError):
        more = None
    if not isinstance(more, dict):
        raise ValueError("its header `more` must be a JSON object")
    return {**more, "name": names, **rows, **_timed(headers)}


def _timed(headers: Mapping[str, Header]) -> dict[str, float]:
    try:
        time = float(headers.get(TIME, 0.0))
    except (ValueError, OverflowError):
        time = math.nan
    if not math.isfinite(time):
        raise ValueError("its header `time` must be a number")
    return {TIME: time} if TIME in headers else {}
