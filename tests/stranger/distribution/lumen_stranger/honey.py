"""The sense of honey."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Honey:
    """How many pots of honey are left."""

    time: float
    pots: int


def encode(reading: Honey) -> dict[str, Any]:
    return {"pots": reading.pots, "time": reading.time}


def decode(body: Mapping[str, Any], joints: Sequence[str]) -> Honey:
    return Honey(float(body["time"]), int(body["pots"]))
