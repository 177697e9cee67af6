"""Bodies as they cross a bus: JSON data, in memory and as bytes.

What one side does with a body must not be seen by another, so every reader gets a copy of its own. Copying containers
and sharing the scalars in them is several times cheaper than a round trip through text, and as strict.
"""

import json
from math import isfinite
from typing import Any

from lumen.errors import BusError

MAX_DEPTH = 64
MAX_BYTES = 1024 * 1024
MAX_KEY = 255
TEXT = "text/plain"
JSON = "application/json"

_SCALARS = frozenset((str, int, bool, type(None)))


def copied(body: Any, depth: int = MAX_DEPTH) -> Any:
    """A copy that shares no container with `body`; tuples become lists, as JSON would have them.

    Raises BusError for what JSON can't say: other types, keys that are no texts, NaN and infinity, deep nesting.
    """
    kind = type(body)
    if kind in _SCALARS:
        return body
    if kind is float:
        if isfinite(body):
            return body
        raise BusError(f"{body} can't be sent: JSON has no such number")
    if not depth:
        raise BusError(f"a body may be nested {MAX_DEPTH} levels deep")
    if kind is dict:
        return {
            key if type(key) is str else _key(key): value if type(value) in _SCALARS else copied(value, depth - 1)
            for key, value in body.items()
        }
    if kind is list or kind is tuple:
        return [value if type(value) in _SCALARS else copied(value, depth - 1) for value in body]
    return _derived(body, depth)


def _key(key: object) -> str:
    if isinstance(key, str):
        return str(key)
    raise BusError(f"the keys of a body are texts, not {type(key).__name__} ({key!r})")


def _derived(body: object, depth: int) -> Any:
    """What a subclass of a JSON type (a StrEnum, a NamedTuple, an OrderedDict) is in JSON."""
    if isinstance(body, str):
        return str.__str__(body)
    if isinstance(body, int):
        return int(body)
    if isinstance(body, float):
        return copied(float(body))
    if isinstance(body, dict):
        return copied(dict(body), depth)
    if isinstance(body, list | tuple):
        return copied(list(body), depth)
    raise BusError(f"a body is JSON data, and {type(body).__name__} is not")


def check_key(key: str) -> None:
    """Raise BusError where AMQP could not carry this key: a text of 255 bytes at most."""
    if not isinstance(key, str) or len(key.encode(errors="replace")) > MAX_KEY:
        raise BusError(f"a key is a text of at most {MAX_KEY} bytes, not {str(key)[:40]!r}")


def encode(body: Any) -> bytes:
    """The body as JSON in UTF-8; raises BusError where it is not JSON data or too large."""
    try:
        data = json.dumps(copied(body), ensure_ascii=False, separators=(",", ":")).encode()
    except UnicodeEncodeError as error:
        raise BusError("a text in the body is not valid Unicode: it holds half a surrogate pair") from error
    if len(data) > MAX_BYTES:
        raise BusError(f"a body may have {MAX_BYTES:,} bytes, and this one has {len(data):,}")
    return data


def decode(data: bytes, content_type: str = JSON) -> Any:
    """The body in these bytes, JSON or (`text/plain`) the text itself; raises ValueError that says what is wrong."""
    if len(data) > MAX_BYTES:
        raise ValueError(f"it has more than {MAX_BYTES:,} bytes")
    try:
        text = data.decode()
        if content_type.startswith(TEXT):
            return text
        body = json.loads(text, parse_constant=_no_constant)
    except UnicodeDecodeError as error:
        raise ValueError(f"it is not UTF-8 ({error.reason} at byte {error.start})") from error
    except json.JSONDecodeError as error:
        raise ValueError(f"it is not JSON ({error})") from error
    except RecursionError as error:
        raise ValueError(f"it is nested deeper than {MAX_DEPTH} levels") from error
    if text.count("[") + text.count("{") > MAX_DEPTH and not _shallow(body, MAX_DEPTH):
        raise ValueError(f"it is nested deeper than {MAX_DEPTH} levels")
    return body


def _shallow(body: Any, depth: int) -> bool:
    if isinstance(body, dict | list):
        values = body.values() if isinstance(body, dict) else body
        return depth > 0 and all(_shallow(value, depth - 1) for value in values)
    return True


def _no_constant(name: str) -> Any:
    raise ValueError(f"it is not JSON (it holds {name})")
