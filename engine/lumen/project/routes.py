"""Build `Route`s from the plain data of the table under `routes:` of lumen.yaml."""

from collections.abc import Mapping
from typing import Any

from lumen.language.diagnostics import NodePath
from lumen.language.durations import duration_hint
from lumen.language.routes import COMMAND, JSON_TYPE, STOP, Carried, Direction, Route, Size
from lumen.project.document_report import DocumentReport
from lumen.project.units import BAD_DURATION, seconds

DEFAULT_LATENCY = 0.15
"""The assumed age of a message without a `time` if its route has no `latency` [s]."""

PERIODS: Mapping[str, float] = {"s": 1.0, "min": 60.0}
"""The units of time in `most` of a route, in [s]."""
_USUAL = {COMMAND: Carried.COMMAND, STOP: Carried.STOP}
"""The way in which a route is carried if its name implies it."""


def build_routes(
    data: Mapping[str, Any], report: DocumentReport, where: NodePath = ("routes",), stand: str = ""
) -> dict[str, Route]:
    """Return the routes by name, in the order written; `{stand}` in keys becomes `stand`, unless that is empty."""
    return {name: build_route(name, row, report, (*where, name), stand) for name, row in data.items()}


def build_route(name: str, data: Mapping[str, Any], report: DocumentReport, where: NodePath, stand: str = "") -> Route:
    """Return the route of one row; a duration that can't be read is reported and left out."""
    latency = duration(data, "latency", report, where)
    carried = Carried(data.get("carried", _USUAL.get(name, Carried.TELEMETRY)))
    return Route(
        name=name,
        key=data["key"].replace("{stand}", stand or "{stand}"),
        direction=Direction(data["direction"]),
        schema=data.get("schema", ""),
        event=data.get("event", ""),
        every=duration(data, "every", report, where, positive=True),
        size=_size(data),
        ttl=duration(data, "ttl", report, where, positive=True),
        keep=int(data["keep"]) if "keep" in data else None,
        carried=carried,
        must_arrive=data.get("must_arrive", carried is not Carried.TELEMETRY),
        most=_rate(data),
        alias=data.get("alias", ""),
        of=data.get("of", ""),
        content_type=data.get("content_type", JSON_TYPE),
        latency=DEFAULT_LATENCY if latency is None else latency,
        where=where,
    )


def _size(data: Mapping[str, Any]) -> Size | None:
    return Size(*map(int, data["size"].split("x"))) if "size" in data else None


def _rate(data: Mapping[str, Any]) -> float | None:
    """Return the rate in `data`, such as `50/s` or `30/min`, in [1/s]; None if there is no rate.

    The schema checked the form.
    """
    number, _, unit = data.get("most", "").partition("/")
    return float(number) / PERIODS[unit] if number else None


def duration(
    data: Mapping[str, Any], key: str, report: DocumentReport, where: NodePath, *, positive: bool = False
) -> float | None:
    """Return the duration under a key [s]; None if the key is absent.

    A duration that can't be read, and if `positive` one of 0, is reported, and the result is None.
    """
    if key not in data:
        return None
    length = seconds(data[key])
    if length is None:
        report(BAD_DURATION, (*where, key), f"`{data[key]}` is not a duration", hint=duration_hint(data[key]))
    elif positive and length <= 0.0:
        report(
            BAD_DURATION, (*where, key), f"`{key}` must be longer than 0", hint="write a longer time, or delete the key"
        )
        return None
    return length
