"""What the variables of a fuzzy controller are bound to: fields of messages, and joints."""

from collections.abc import Iterator, Mapping
from typing import Any

from lumen.language.controllers import InputBinding, OutputBinding, Variable
from lumen.language.diagnostics import ERROR, WARNING, Code, NodePath, did_you_mean
from lumen.loading.document_report import DocumentReport
from lumen.loading.numbers import EMPTY_RANGE
from lumen.loading.rulebook import UNKNOWN_VARIABLE
from lumen.loading.units import ANGLES

UNBOUND_INPUT = Code(
    "unbound-input", "controllers", ERROR, "an input of a bound controller has no message field to come from"
)
UNBOUND_OUTPUT = Code("unbound-output", "controllers", WARNING, "an output of a bound controller moves no joint")


class Bindings:
    """Reads `bind:` of one file, whose unit of angles is `angle` [rad]; without it nothing has to be bound."""

    def __init__(
        self, data: Mapping[str, Any], report: DocumentReport, outputs: Mapping[str, Variable], angle: float
    ) -> None:
        self.data, self.report, self.usable, self.angle = data, report, outputs, angle
        bind = data.get("bind") or {}
        self.fields: Mapping[str, str] = bind.get("inputs") or {}
        self.joints: Mapping[str, Mapping[str, Any]] = bind.get("outputs") or {}

    def inputs(self) -> Iterator[InputBinding]:
        """Each bound input with its route and field."""
        message, hint = "gets its value from nowhere", "route.field"
        self.all_bound("inputs", self.fields, UNBOUND_INPUT, message, hint)
        for name, field in self.fields.items():
            if self.known("inputs", name):
                route, *path = field.split(".")
                yield InputBinding(name, route, tuple(path), ("bind", "inputs", name))

    def outputs(self) -> Iterator[OutputBinding]:
        """Each bound output with its joint."""
        message, hint = "moves nothing", "{joint: HeadYaw, gain: 1.5}"
        self.all_bound("outputs", self.joints, UNBOUND_OUTPUT, message, hint)
        for name, spec in self.joints.items():
            if self.known("outputs", name) and name in self.usable and "joint" in spec:
                yield from self.output(self.usable[name], spec)

    def output(self, variable: Variable, spec: Mapping[str, Any]) -> Iterator[OutputBinding]:
        path: NodePath = ("bind", "outputs", variable.name)
        unit = ANGLES.get(variable.unit, self.angle)
        low = high = None
        if "limits" in spec:
            low, high = (end * self.angle for end in spec["limits"])
            if not low < high:
                message = f"the limits of `{spec['joint']}` leave it no way to move"
                self.report(EMPTY_RANGE, (*path, "limits"), message, hint="the second number has to be greater")
                return
        yield OutputBinding(variable.name, spec["joint"], float(spec.get("gain", 1.0)), low, high, unit, path)

    def known(self, side: str, name: str) -> bool:
        """Whether a bound variable exists, saying so where it does not."""
        if name in self.data[side]:
            return True
        hint = did_you_mean(name, self.data[side], f"the {side} are")
        message = f"there is no {side[:-1]} `{name}`"
        cause = f"{self.report.document.file} unknown-variable {name}"
        self.report(UNKNOWN_VARIABLE, ("bind", side, name), message, hint=hint, key=True, cause=cause)
        return False

    def all_bound(self, side: str, bound: Mapping[str, Any], code: Code, lack: str, example: str) -> None:
        """Report variables that are bound to nothing, in a file that binds."""
        for name in self.data[side] if "bind" in self.data else ():
            if name not in bound and name not in self.report.lost:
                message, hint = f"`{name}` is not bound: it {lack}", f"write `{name}: {example}` under `bind`, `{side}`"
                self.report(code, (side, name), message, hint=hint, key=True)
