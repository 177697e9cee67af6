"""Bodies as they cross a bus: JSON data, in memory and as bytes.

A receiver's changes to a body must not be visible to others, so each gets its own copy. Copying containers and sharing
their scalars is several times cheaper than a round trip through text, and as strict.
"""

import codecs
import json
from collections.abc import Sequence
from math import isfinite
from typing import Any

import orjson

from lumen.errors import BadMessageError

MAX_BODY_DEPTH = 64
"""The deepest nesting of lists and objects that a body may have."""
MAX_BODY_BYTES = 1024 * 1024
"""Longest body [bytes of JSON in UTF-8]."""
MAX_KEY_BYTES = 255
"""Longest routing key [bytes]: AMQP's limit for a short string."""
MAX_TTL = 10 * 365 * 24 * 3600
"""Longest lifetime of a message [s]."""
TEXT = "text/plain"
JSON = "application/json"
UTF_16 = "it is UTF-16: send UTF-8"

MIN_INTEGER, MAX_INTEGER = -(2**63), 2**63
"""Limits of integers: every language can store those between them, and a float does not overflow."""

_SCALARS = frozenset((str, bool, type(None)))
_FLOATS, _INTEGERS = frozenset((float,)), frozenset((int,))


def copied(body: Any, depth: int = MAX_BODY_DEPTH) -> Any:
    """Return a copy that shares no container with `body`; tuples become lists, as in JSON.

    Raises BusError for what JSON can't express: other types, keys that are not strings, NaN and infinity; and for
    integers beyond ±2**63 and nesting deeper than `depth`.
    """
    kind = type(body)
    if kind is dict and depth:
        return _object(body, depth - 1)
    if kind in _SCALARS:
        return body
    if kind is float or kind is int:
        return _number(body)
    if not depth:
        raise BadMessageError(f"a body must not be nested deeper than {MAX_BODY_DEPTH} levels")
    if kind is list or kind is tuple:
        return list(body) if _plain(body) else [copied(value, depth - 1) for value in body]
    return _derived(body, depth)


def _object(body: dict[Any, Any], depth: int) -> dict[str, Any]:
    """Copy an object, in a loop with the common types first, because nearly every message passes through here."""
    own = {}
    for key, value in body.items():
        kind = type(value)
        if kind is float:
            if not isfinite(value):
                _number(value)
        elif kind is int:
            if not MIN_INTEGER <= value <= MAX_INTEGER:
                _number(value)
        elif kind not in _SCALARS:
            value = copied(value, depth)
        own[key if type(key) is str else _key(key)] = value
    return own


def _plain(values: Sequence[Any]) -> bool:
    """Return whether a list has only strings, booleans and nulls, or only valid numbers, and can be shared at once."""
    kinds = set(map(type, values))
    if kinds == _FLOATS:
        return isfinite(sum(values))
    if kinds == _INTEGERS:
        return bool(min(values) >= MIN_INTEGER and max(values) <= MAX_INTEGER)
    return kinds <= _SCALARS


def _number(number: float) -> float:
    if isinstance(number, int):
        if MIN_INTEGER <= number <= MAX_INTEGER:
            return number
        raise BadMessageError("an integer in a body must be between -2**63 and 2**63")
    if isfinite(number):
        return number
    raise BadMessageError(f"JSON has no number `{number}`")


def _key(key: object) -> str:
    if isinstance(key, str):
        return str(key)
    raise BadMessageError(f"the keys of a body must be strings, not {type(key).__name__} ({key!r})")


def _derived(body: object, depth: int) -> Any:
    """Convert an instance of a subclass of a JSON type (a StrEnum, a NamedTuple, an OrderedDict) to JSON data."""
    if isinstance(body, str):
        return str.__str__(body)
    if isinstance(body, int):
        return copied(int(body))
    if isinstance(body, float):
        return copied(float(body))
    if isinstance(body, dict):
        return copied(dict(body), depth)
    if isinstance(body, list | tuple):
        return copied(list(body), depth)
    raise BadMessageError(f"a body must be JSON data, not {type(body).__name__}")


def check_key(key: str) -> None:
    """Raise BusError if AMQP can't carry this key: it must be a string of at most 255 bytes."""
    if not isinstance(key, str) or not _fits(key):
        raise BadMessageError(f"a key must be a string of at most {MAX_KEY_BYTES} bytes, not {str(key)[:40]!r}")


def check_subscription(pattern: str, handler: object) -> None:
    """Raise BusError if the pattern is not a valid key, or the handler can't be called."""
    check_key(pattern)
    if not callable(handler):
        raise BadMessageError(f"a subscriber must be a function, not {str(handler)[:40]!r}")


def _fits(key: str) -> bool:
    try:
        return len(key.encode()) <= MAX_KEY_BYTES
    except UnicodeEncodeError:  # half a surrogate pair
        return False


def check_ttl(ttl: object) -> None:
    """Raise BusError unless `ttl` is None or a number from 0 to MAX_TTL [s]."""
    if ttl is not None and not (type(ttl) in (int, float) and 0 <= ttl <= MAX_TTL):  # type: ignore[operator]
        raise BadMessageError(f"a ttl must be a number of seconds from 0 to {MAX_TTL}, not {str(ttl)[:40]!r}")


def encode(body: Any) -> bytes:
    """Return the body as JSON in UTF-8. Raises BusError if it is not JSON data or too large."""
    try:
        data = orjson.dumps(copied(body))
    except orjson.JSONEncodeError as error:
        raise BadMessageError(
            "a string in the body is not valid Unicode: it contains half of a surrogate pair"
        ) from error
    if len(data) > MAX_BODY_BYTES:
        raise BadMessageError(f"a body must have at most {MAX_BODY_BYTES:,} bytes, not {len(data):,}")
    return data


def decode(data: bytes, content_type: str = JSON, content_encoding: str = "") -> Any:
    """Return the body in these bytes: JSON, or for `text/plain` the text itself. Raises ValueError with the reason.

    `content_encoding` comes from the sender; the reason names it if the bytes are not plain UTF-8.
    """
    if len(data) > MAX_BODY_BYTES:
        raise ValueError(f"it has more than {MAX_BODY_BYTES:,} bytes")
    if _is_utf_16(data):
        raise ValueError(UTF_16)
    try:
        text = data.decode()
        return text if content_type.startswith(TEXT) else copied(_decoder.decode(text))
    except UnicodeDecodeError as error:
        reason = f"it is not UTF-8 ({error.reason} at byte {error.start})"
        raise ValueError(_foreign(data, content_encoding) or reason) from error
    except json.JSONDecodeError as error:
        raise ValueError(_foreign(data, content_encoding) or f"it is not JSON ({error})") from error
    except RecursionError as error:
        raise ValueError(f"it is nested deeper than {MAX_BODY_DEPTH} levels") from error
    except BadMessageError as error:
        raise ValueError(str(error)) from error
    except ValueError as error:  # Python's limit is 4,300 digits
        raise ValueError("it contains an integer with thousands of digits") from error


def _is_utf_16(data: bytes) -> bool:
    """Return whether bytes look like ASCII in UTF-16 without a byte order mark: every second byte is zero."""
    even, odd = data[0:8:2], data[1:8:2]
    return bool(odd) and any(all(letters) and not any(zeros) for letters, zeros in ((even, odd), (odd, even)))


def _foreign(data: bytes, content_encoding: str) -> str:
    """Name the encoding that was found instead of plain UTF-8, and the remedy; empty if it can't be recognized."""
    if data.startswith(codecs.BOM_UTF8):
        return "it begins with a byte order mark (BOM), which JSON does not have: send UTF-8 without one"
    if data.startswith((codecs.BOM_UTF32_LE, codecs.BOM_UTF32_BE)):
        return "it is UTF-32: send UTF-8"
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return UTF_16
    if data.startswith(b"\x1f\x8b"):
        return "it is compressed with gzip: send it as it is, without a content encoding"
    if content_encoding.lower() not in ("", "utf-8", "utf8", "identity"):
        return f"its content encoding is `{content_encoding}`: send plain UTF-8, without a content encoding"
    return ""


def text_of_json(body: Any) -> str:
    """Return the reason if a body is a string that contains a JSON object or list; empty for any other body."""
    if not isinstance(body, str) or body.lstrip()[:1] not in ("{", "["):
        return ""
    try:
        _decoder.decode(body)
    except (ValueError, RecursionError, BadMessageError):
        return ""
    return f"it is a string that contains JSON: encode it once, and send it with the content type {JSON}, not {TEXT}"


def _no_constant(name: str) -> Any:
    raise BadMessageError(f"it is not JSON (it contains {name})")


_decoder = json.JSONDecoder(parse_constant=_no_constant)
