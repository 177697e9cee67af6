"""What an output of a fuzzy controller does that moves no joint, from the data of `bind`."""

from collections.abc import Mapping
from math import isfinite
from typing import Any, NamedTuple

from lumen.language.controllers import (
    ContextBinding,
    MessageBinding,
    SignalBinding,
    ThresholdBinding,
    Variable,
    VolumeBinding,
)
from lumen.language.diagnostics import WARNING, Code, NodePath
from lumen.project.complaints import WRONG_VALUE

UNBOUND_OUTPUT = Code(
    "unbound-output", "controllers", WARNING, "an output of a controller is bound to nothing, or to two targets"
)

STEP_SHARE = 0.02
"""By which part of its range an output has to change to be told anew, where the file does not say."""

HYSTERESIS_SHARE = 0.05
"""By which part of its range an output has to come back before its threshold counts again, where nothing is said."""


DEEDS = ("joint", "volume", "message", "context", "event")
"""What an output can do; it does one of these."""


class BindingFault(NamedTuple):
    """Why what an output is bound to can't be read: a message that goes on from its name, and what would be right."""

    code: Code
    message: str
    hint: str


def signal_fault(spec: str | Mapping[str, Any]) -> BindingFault | None:
    """What is wrong with what an output is bound to, None where nothing is."""
    if isinstance(spec, str):
        return None
    deeds = [deed for deed in DEEDS if deed in spec]
    ends = [end for end in ("above", "below") if end in spec]
    if not deeds:
        return BindingFault(
            UNBOUND_OUTPUT, "is bound to nothing, so it has no effect", f"write one of {', '.join(DEEDS)}"
        )
    if len(deeds) > 1:
        said = " and ".join(f"`{deed}`" for deed in deeds)
        return BindingFault(
            WRONG_VALUE, f"is bound to {said}, but only one is allowed", "use a separate output for each"
        )
    if deeds == ["event"] and len(ends) != 1:
        hint = "write `above: 0.7`, or `below: 0.2`"
        return BindingFault(WRONG_VALUE, "needs one threshold for its event", hint)
    return None


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
