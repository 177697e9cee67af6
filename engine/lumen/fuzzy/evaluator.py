"""Evaluation of a controller, which is compiled once, for single inputs or for hundreds of thousands."""

from collections.abc import Mapping
from functools import cached_property
from math import isnan
from typing import TYPE_CHECKING, Any

from lumen.errors import LumenError, UsageError
from lumen.fuzzy.arithmetic import NUMBERS, arrays
from lumen.fuzzy.defuzzifiers import defuzzifier
from lumen.fuzzy.program import InferenceProgram
from lumen.language.controllers import ControllerDefinition, Variable
from lumen.language.diagnostics import did_you_mean

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from lumen.fuzzy.arithmetic import Array

_CHUNK = 1 << 13  # rows of a batch that are processed together: few enough for the cache


class Evaluator:
    """A compiled controller; it is pure and keeps only precomputed values between evaluations."""

    def __init__(self, controller: ControllerDefinition) -> None:
        self.controller = controller
        self.program = InferenceProgram(controller, NUMBERS)
        self._names = tuple(controller.inputs)
        names, count = (*controller.inputs, *controller.outputs), len(controller.inputs)
        self._outputs = [
            (variable, defuzzifier(variable, self.program.conclusions[name], names, count), self._slots(name))
            for name, variable in controller.outputs.items()
        ]

    def evaluate(self, inputs: Mapping[str, float], previous: Mapping[str, float] | None = None) -> dict[str, float]:
        """Return the outputs by name, in their own units.

        An output for which no rule fires has its value in `previous` if `lock_previous` is set, else its default.
        Raises UsageError if an input is missing, unknown or not a number, LumenError if an output has none of these
        values.
        """
        values = self._values(inputs)
        tape = self.program.run(values)
        result: dict[str, float] = {}
        for variable, output, slots in self._outputs:
            value = output.crisp([tape[slot] for slot in slots], values) if slots else float("nan")
            if variable.lock_range:
                value = min(max(value, variable.minimum), variable.maximum)
            if value - value != 0.0:  # NaN, or infinite
                value = _fallback(variable, inputs, previous)
            result[variable.name] = value
            values.append(value)
        return result

    def evaluate_batch(
        self, inputs: "Mapping[str, ArrayLike]", previous: Mapping[str, float] | None = None
    ) -> "dict[str, Array]":
        """Return arrays of outputs, Shape (n,), for inputs of Shape (n,) each; raises the same errors as `evaluate`.

        The rows count as successive evaluations: `previous` is used for the first one. Raises UsageError if the inputs
        have different shapes.
        """
        import numpy as np

        columns = self._columns(inputs)
        before, parts = dict(previous or {}), []
        for i in range(0, len(columns[0]), _CHUNK):
            parts.append(self._chunk([c[i : i + _CHUNK] for c in columns], before))
            before = {name: float(values[-1]) for name, values in parts[-1].items()}
        empty = [dict.fromkeys(self.controller.outputs, np.zeros(0))]
        return {name: np.concatenate([part[name] for part in parts or empty]) for name in self.controller.outputs}

    @cached_property
    def _array_program(self) -> InferenceProgram:
        return InferenceProgram(self.controller, arrays())

    def _slots(self, name: str) -> list[int]:
        return [conclusion.slot for conclusion in self.program.conclusions[name]]

    def _values(self, inputs: Mapping[str, float]) -> list[float]:
        try:
            values = [float(inputs[name] + 0.0) for name in self._names]  # a text raises here: it is no number
        except KeyError as error:
            raise UsageError(f"the input `{error.args[0]}` of `{self.controller.name}` is missing") from None
        except (TypeError, ValueError, OverflowError):
            raise self._no_numbers(inputs) from None
        if len(inputs) != len(values):
            self._refuse_unknown(inputs)
        for value in values:
            if value != value:
                raise UsageError(f"an input of `{self.controller.name}` is not a number: {dict(inputs)}")
        return values

    def _columns(self, inputs: "Mapping[str, ArrayLike]") -> "list[Array]":
        import numpy as np

        self._refuse_unknown(inputs)
        if missing := [name for name in self._names if name not in inputs]:
            raise UsageError(f"the input `{missing[0]}` of `{self.controller.name}` is missing")
        try:
            given = [np.atleast_1d(np.asarray(inputs[name])) for name in self._names]
            if any(column.dtype.kind not in "biuf" for column in given if column.size):
                raise self._no_numbers(inputs)
            columns = [column.astype(float) for column in given]
        except (TypeError, ValueError, OverflowError):
            raise self._no_numbers(inputs) from None
        if any(column.shape != columns[0].shape or column.ndim != 1 for column in columns):
            shapes = {name: c.shape for name, c in zip(self._names, columns, strict=True)}
            raise UsageError(f"the inputs of a batch must have the same shape (n,), not {shapes}")
        if any(np.isnan(column).any() for column in columns):
            raise UsageError(f"an input of `{self.controller.name}` contains values that are not numbers")
        return columns

    def _no_numbers(self, inputs: Mapping[str, Any]) -> UsageError:
        return UsageError(f"the inputs of `{self.controller.name}` must be numbers, not {str(inputs)[:200]}")

    def _refuse_unknown(self, inputs: Mapping[str, Any]) -> None:
        for name in inputs:
            if name not in self._names:
                hint = did_you_mean(name, self._names, "its inputs are")
                raise UsageError(f"`{self.controller.name}` has no input `{name}`: {hint}")

    def _chunk(self, columns: "list[Array]", previous: Mapping[str, float]) -> "dict[str, Array]":
        import numpy as np

        shape, values = columns[0].shape, list(columns)
        result: dict[str, Array] = {}
        with np.errstate(all="ignore"):  # both sides of a `where` are computed; the selected one is in its domain
            tape = self._array_program.run(columns)
            for variable, output, slots in self._outputs:
                degrees = [np.broadcast_to(tape[slot], shape) for slot in slots]
                found = output.crisp_batch(degrees, values) if slots else np.full(shape, np.nan)
                result[variable.name] = self._filled(variable, found, columns, previous)
                values.append(result[variable.name])
        return result

    def _filled(
        self, variable: Variable, values: "Array", columns: "list[Array]", previous: Mapping[str, float]
    ) -> "Array":
        """Return the values with gaps filled: by the previous value if the output locks it, else by the default."""
        import numpy as np

        if variable.lock_range:
            values = np.clip(values, variable.minimum, variable.maximum)
        if not (gaps := ~np.isfinite(values)).any():
            return values
        if variable.lock_previous:
            latest = np.maximum.accumulate(np.where(gaps, -1, np.arange(len(values))))
            values = np.where(latest >= 0, values[latest], np.nan)
            gaps = np.isnan(values)
        if gaps.any():
            row = int(gaps.argmax())
            first = {name: float(column[row]) for name, column in zip(self._names, columns, strict=True)}
            values = np.where(gaps, _fallback(variable, first, previous), values)
        return values


def _fallback(variable: Variable, inputs: Mapping[str, float], previous: Mapping[str, float] | None) -> float:
    """Return the value of an output without a result: no rule fires, or none that fires has a value.

    It is the previous value or the default. Raises LumenError without a default.
    """
    if variable.lock_previous and previous and not isnan(previous.get(variable.name, float("nan"))):
        return previous[variable.name]
    if variable.default is not None:
        return variable.default
    given = ", ".join(f"{name} = {value:g}" for name, value in inputs.items())
    raise LumenError(f"no rule for `{variable.name}` fires at {given}: add a `default` to the output")


def infer(
    controller: ControllerDefinition, inputs: Mapping[str, float], previous: Mapping[str, float] | None = None
) -> dict[str, float]:
    """Return the outputs of a controller, compiled for this one evaluation; for several, keep an `Evaluator`."""
    return Evaluator(controller).evaluate(inputs, previous)
