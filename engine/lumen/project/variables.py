"""Read the variables of a fuzzy controller: ranges, terms, and the defuzzification of outputs."""

from collections.abc import Mapping
from dataclasses import replace
from math import isfinite
from typing import Any

from lumen.fuzzy.weighted import INVERSE_MEMBERSHIPS
from lumen.language.controllers import VALUE_TERMS, WEIGHTED_DEFUZZIFIERS, Variable
from lumen.language.diagnostics import ERROR, Code, NodePath
from lumen.project.document_report import DocumentReport
from lumen.project.numbers import EMPTY_RANGE, NOT_FINITE
from lumen.project.terms import build_terms, plain_name

DUPLICATE_VARIABLE = Code("duplicate-variable", "controllers", ERROR, "an input and an output have the same name")
TERM_WITHOUT_SET = Code("term-without-set", "controllers", ERROR, "a term has no set, but the defuzzifier needs one")
TERM_WITHOUT_VALUE = Code(
    "term-without-value", "controllers", ERROR, "a term has no value, but the defuzzifier needs one"
)


def build_variables(data: Mapping[str, Any], report: DocumentReport, side: str) -> dict[str, Variable]:
    """Return the usable `inputs` or `outputs` (`side`) of a controller's data, by name."""
    reader = _Variables(data, report, side)
    found = (reader.variable(name, spec) for name, spec in data[side].items())
    return {variable.name: variable for variable in found if variable}


class _Variables:
    """Reads the inputs or the outputs of one controller."""

    def __init__(self, data: Mapping[str, Any], report: DocumentReport, side: str) -> None:
        self.data, self.report, self.side = data, report, side
        self.operators = data.get("operators") or {}

    def variable(self, name: str, spec: Mapping[str, Any]) -> Variable | None:
        self.named(name)
        if "range" not in spec or (self.side == "outputs" and not spec.get("terms")):
            return None
        low, high = (float(end) for end in spec["range"])
        if not self.spans(name, low, high):
            return None
        path: NodePath = (self.side, name)
        variable = Variable(
            name,
            low,
            high,
            build_terms(
                spec.get("terms") or {}, self.report, (*path, "terms"), len(self.data["inputs"]), self.named_in(name)
            ),
            unit=spec.get("unit", ""),
            direction=spec.get("direction", ""),
            default=spec.get("default"),
            neutral=spec.get("neutral"),
            lock_range=spec.get("lock-range", False),
            lock_previous=spec.get("lock-previous", False),
            where=path,
        )
        if self.side == "outputs":
            variable = self.defuzzified(variable, spec)
        self.fits(variable)
        return variable

    def named(self, name: str) -> None:
        plain_name(name, self.report, (self.side, name))
        if self.side == "outputs" and name in self.data["inputs"]:
            message = f"`{name}` is already the name of an input"
            self.report(DUPLICATE_VARIABLE, ("outputs", name), message, hint="rename one of them", key=True)

    def named_in(self, name: str) -> tuple[str, ...]:
        """Return the variables that a formula in a term of the variable `name` may use.

        With a weighted defuzzifier, these are the inputs and the outputs before it; otherwise none.
        """
        spec = self.data[self.side][name]
        if (
            self.side == "inputs"
            or {**self.operators, **spec}.get("defuzzifier", "centroid") not in WEIGHTED_DEFUZZIFIERS
        ):
            return ()
        outputs = list(self.data["outputs"])
        return (*self.data["inputs"], *outputs[: outputs.index(name)])

    def spans(self, name: str, low: float, high: float) -> bool:
        """Return True if the range is not empty, and for an output finite; otherwise, report the range."""
        path: NodePath = (self.side, name, "range")
        if not low < high:
            hint = (
                f"write [{high:g}, {low:g}]" if high < low else "write a second number that is greater than the first"
            )
            self.report(EMPTY_RANGE, path, f"the range [{low:g}, {high:g}] of `{name}` is empty", hint=hint)
        elif self.side == "outputs" and not (isfinite(low) and isfinite(high)):
            message = f"the range of the output `{name}` is infinite"
            self.report(NOT_FINITE, path, message, hint="write a range of two numbers")
        else:
            return True
        return False

    def defuzzified(self, variable: Variable, spec: Mapping[str, Any]) -> Variable:
        """Return the output with its own settings of defuzzification, or else the file's.

        By default, sets are combined by their maximum, and values for a weighted defuzzifier by their unbounded sum.
        """
        said = {**self.operators, **spec}
        method = said.get("defuzzifier", "centroid")
        usual = "unbounded-sum" if method in WEIGHTED_DEFUZZIFIERS else "maximum"
        return replace(
            variable,
            defuzzifier=method,
            aggregation=said.get("aggregation", usual),
            resolution=int(said.get("resolution", 1000)),
            accuracy=said.get("accuracy"),
        )

    def fits(self, variable: Variable) -> None:
        """Report terms that the variable can't use: values if it needs sets, and sets if it needs values."""
        output = self.side == "outputs"
        weighted = output and variable.weighted
        for term in variable.terms.values():
            path = (*term.where, term.kind)
            if weighted and term.kind not in (*VALUE_TERMS, "function", *INVERSE_MEMBERSHIPS):
                message = f"`{variable.defuzzifier}` can't use `{term.kind}`, which has no single value"
                hint = (
                    f"use one of `constant`, `linear`, `function`, {', '.join(f'`{k}`' for k in INVERSE_MEMBERSHIPS)}"
                )
                self.report(TERM_WITHOUT_VALUE, path, message, hint=hint, key=True)
            elif not weighted and term.kind in VALUE_TERMS:
                what = f"`{variable.defuzzifier}` needs sets" if output else "an input needs sets"
                hint = "use `defuzzifier: weighted-average`" if output else "use a shape such as `triangle`"
                message = f"{what}, but `{term.kind}` is a single value"
                self.report(TERM_WITHOUT_SET, path, message, hint=hint, key=True)
