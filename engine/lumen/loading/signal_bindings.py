"""What an output of a fuzzy controller does that moves no joint, from the data of `bind`."""

from collections.abc import Mapping
from math import isfinite
from typing import Any

from lumen.language.controllers import (
    ContextBinding,
    MessageBinding,
    SignalBinding,
    ThresholdBinding,
    Variable,
    VolumeBinding,
)
from lumen.language.diagnostics import NodePath

STEP_SHARE = 0.02
"""By which part of its range an output has to change to be told anew, where the file does not say."""

HYSTERESIS_SHARE = 0.05
"""By which part of its range an output has to come back before its threshold counts again, where nothing is said."""


def build_signal(variable: Variable, spec: str | Mapping[str, Any], path: NodePath) -> SignalBinding | None:
    """What `volume`, `route.field` or a map at `path` says that the output does; None for a joint."""
    name = variable.name
    if isinstance(spec, str):
        spec = {"volume": True} if spec == "volume" else {"message": spec}
    step = float(spec.get("step", _share(variable, STEP_SHARE)))
    match spec:
        case {"volume": _}:
            return VolumeBinding(name, step, path)
        case {"message": str(field)}:
            route, *steps = field.split(".")
            return MessageBinding(name, route, tuple(steps), step, spec.get("body", {}), path)
        case {"context": str(key)}:
            return ContextBinding(name, key, step, path)
        case {"event": str(event)} if "above" in spec or "below" in spec:
            back = float(spec.get("hysteresis", _share(variable, HYSTERESIS_SHARE)))
            rising = "above" in spec
            return ThresholdBinding(name, event, float(spec["above" if rising else "below"]), rising, back, path)
    return None


def _share(variable: Variable, share: float) -> float:
    span = variable.maximum - variable.minimum
    return share * span if isfinite(span) else 0.0
