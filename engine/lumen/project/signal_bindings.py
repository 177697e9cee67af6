"""Read the data of `bind` for outputs of a fuzzy controller that move no joint."""

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
"""The default of `step`: the share of its range by which an output must change to be sent again."""

HYSTERESIS_SHARE = 0.05
"""The default of `hysteresis`: the share of its range by which an output must return to rearm its threshold."""


DEEDS = ("joint", "volume", "message", "context", "event")
"""The kinds of target of an output; each output has only one."""


class BindingFault(NamedTuple):
    """Why the binding of an output can't be read; the message continues a sentence that begins with its name."""

    code: Code
    message: str
    hint: str


def signal_fault(spec: str | Mapping[str, Any]) -> BindingFault | None:
    """Return the fault of an output's binding; None if it is sound."""
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
    """Return the binding to `volume`, to `route.field` or to the target in a map at `path`; None for a joint."""
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
