"""Passages between postures, `models/passages/NAME.yaml`: which of them belong to a body."""

from collections.abc import Iterator, Mapping
from typing import Any

from lumen.language.json_paths import values_in
from lumen.language.robots import Body


def belongs_to(data: Any, body: Body) -> bool:
    """Whether a passage is one of this body: it knows both postures, and one of the joints that are named."""
    if not isinstance(data, Mapping) or not {"start", "end"} <= data.keys():
        return True  # what is wrong with it is told
    named = set(_joints(data))
    known = data["start"] in body.postures and data["end"] in body.postures
    return known and not (named and named.isdisjoint(body.joints))


def _joints(data: Any) -> Iterator[str]:
    """Every joint that a motion's file names."""
    for item in values_in(data):
        if isinstance(item, Mapping) and isinstance(item.get("joints"), Mapping):
            yield from item["joints"]
