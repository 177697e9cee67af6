"""The bindings of a fuzzy controller's variables: message fields, context keys, joints and signals."""

from collections.abc import Iterator, Mapping
from math import isfinite
from typing import Any, NamedTuple

from lumen.language.controllers import (
    ContextBinding,
    ContextInput,
    InputBinding,
    MessageBinding,
    OutputBinding,
    SignalBinding,
    ThresholdBinding,
    Variable,
    VolumeBinding,
)
from lumen.language.diagnostics import ERROR, WARNING, Code, NodePath, did_you_mean
from lumen.project.complaints import WRONG_VALUE
from lumen.project.document_report import DocumentReport
from lumen.project.numbers import EMPTY_RANGE
from lumen.project.rulebook import UNKNOWN_VARIABLE
from lumen.project.units import ANGLES

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
    """A fault of an output's binding; the message continues a sentence that begins with the output's name."""

    code: Code
    message: str
    hint: str


def signal_fault(spec: str | Mapping[str, Any]) -> BindingFault | None:
    """Return the fault of an output's binding; None if it is valid."""
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
    """Return the binding that `spec` at `path` describes; None for a joint.

    `spec` is `volume`, `route.field` or a map that names the target. It must have passed `signal_fault`.
    """
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


UNBOUND_INPUT = Code("unbound-input", "controllers", ERROR, "an input of a bound controller has no source")


class Bindings:
    """Reads `bind:` of one file, whose unit of angles is `angle` [rad].

    In a file without `bind:`, variables need no binding.
    """

    def __init__(
        self, data: Mapping[str, Any], report: DocumentReport, outputs: Mapping[str, Variable], angle: float
    ) -> None:
        self.data, self.report, self.usable, self.angle = data, report, outputs, angle
        bind = data.get("bind") or {}
        self.sources: Mapping[str, str | Mapping[str, str]] = bind.get("inputs") or {}
        self.targets: Mapping[str, str | Mapping[str, Any]] = bind.get("outputs") or {}

    def inputs(self) -> Iterator[InputBinding]:
        """Yield each input that is read from a message, with its route and field; report inputs without a source."""
        message, hint = "has no source for its value", "route.field"
        self.all_bound("inputs", self.sources, UNBOUND_INPUT, message, hint)
        for name, source in self.sources.items():
            if self.known("inputs", name) and isinstance(source, str):
                route, *path = source.split(".")
                yield InputBinding(name, route, tuple(path), ("bind", "inputs", name))

    def context_inputs(self) -> Iterator[ContextInput]:
        """Yield each input that is read from the context; report it if the controller also moves a joint.

        Joints are moved by a process that has no access to the context of a behaviour.
        """
        joint = next((name for name, spec in self.targets.items() if isinstance(spec, Mapping) and "joint" in spec), "")
        for name, source in self.sources.items():
            if name not in self.data["inputs"] or not isinstance(source, Mapping):
                continue
            path: NodePath = ("bind", "inputs", name)
            if joint:
                message = (
                    f"`{name}` comes from the context, but `{joint}` moves a joint: joints can follow only messages"
                )
                self.report(
                    UNBOUND_INPUT,
                    path,
                    message,
                    hint="bind this input in another controller, whose outputs move no joints",
                )
            yield ContextInput(name, source["context"], path)

    def outputs(self) -> Iterator[OutputBinding]:
        """Yield each output that moves a joint; report outputs that are bound to nothing."""
        message, hint = "does nothing", "{joint: head.yaw, gain: 1.5}"
        self.all_bound("outputs", self.targets, UNBOUND_OUTPUT, message, hint)
        for name, spec in self.targets.items():
            if self.known("outputs", name) and name in self.usable and isinstance(spec, Mapping) and "joint" in spec:
                yield from self.output(self.usable[name], spec)

    def signals(self) -> Iterator[SignalBinding]:
        """Yield each output that is bound to something other than a joint; report faulty ones."""
        for name, spec in self.targets.items():
            path: NodePath = ("bind", "outputs", name)
            if fault := signal_fault(spec):
                self.report(fault.code, path, f"`{name}` {fault.message}", hint=fault.hint, key=True)
            elif name in self.usable and (signal := build_signal(self.usable[name], spec, path)):
                yield signal

    def output(self, variable: Variable, spec: Mapping[str, Any]) -> Iterator[OutputBinding]:
        path: NodePath = ("bind", "outputs", variable.name)
        unit = ANGLES.get(variable.unit, self.angle)
        low = high = None
        if "limits" in spec:
            low, high = (end * self.angle for end in spec["limits"])
            if not low < high:
                message = f"the limits of `{spec['joint']}` allow no movement"
                self.report(
                    EMPTY_RANGE, (*path, "limits"), message, hint="write a second number that is greater than the first"
                )
                return
        yield OutputBinding(variable.name, spec["joint"], float(spec.get("gain", 1.0)), low, high, unit, path)

    def known(self, side: str, name: str) -> bool:
        """Return True if a bound variable exists; otherwise report the name and return False."""
        if name in self.data[side]:
            return True
        hint = did_you_mean(name, self.data[side], f"the {side} are")
        message = f"there is no {side[:-1]} `{name}`"
        cause = f"{self.report.document.file} unknown-variable {name}"
        self.report(UNKNOWN_VARIABLE, ("bind", side, name), message, hint=hint, key=True, cause=cause)
        return False

    def all_bound(self, side: str, bound: Mapping[str, Any], code: Code, lack: str, example: str) -> None:
        """Report variables that are not bound, if the file has `bind:`."""
        for name in self.data[side] if "bind" in self.data else ():
            if name not in bound and name not in self.report.lost:
                message, hint = f"`{name}` is not bound: it {lack}", f"write `{name}: {example}` under `bind`, `{side}`"
                self.report(code, (side, name), message, hint=hint, key=True)
