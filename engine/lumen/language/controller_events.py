"""The events that controllers raise for behaviours, each with the JSON Schema of its data."""

from collections.abc import Iterable
from math import isfinite
from typing import Any

from lumen.language.controllers import (
    CONTROLLER_EVENT,
    ContextBinding,
    ControllerDefinition,
    ThresholdBinding,
    Variable,
)


def controller_events(controllers: Iterable[ControllerDefinition]) -> dict[str, Any]:
    """Return the data schemas of threshold events, and of the events `controller.NAME` that set the context."""
    found: dict[str, Any] = {}
    for controller in controllers:
        outputs = controller.outputs
        keys = {s.key: _within(outputs[s.variable]) for s in controller.signals if isinstance(s, ContextBinding)}
        if keys:
            found[f"{CONTROLLER_EVENT}{controller.name}"] = {"type": "object", "properties": keys}
        for signal in controller.signals:
            if isinstance(signal, ThresholdBinding):
                value = {"value": _within(outputs[signal.variable])}
                found[signal.event] = {"type": "object", "properties": value, "required": ["value"]}
    return found


def _within(variable: Variable) -> dict[str, Any]:
    """Return the JSON Schema of an output's values, which are numbers within its range."""
    ends = {"minimum": variable.minimum, "maximum": variable.maximum}
    return {"type": "number", **{key: end for key, end in ends.items() if isfinite(end)}}
