"""Evaluates a controller for an image at the magnification that gives the greatest output.

The output for a magnified image is divided by the magnification. Each magnification is half an octave greater than the
one before; the first is 1. The best one moves the face to the point at which the controller's surface, seen from the
neutral points, is steepest. If each output depends on an input of its own, the distance of the input from its neutral
point determines the best magnification, and each image needs only one evaluation. Otherwise all magnifications are
tried.
"""

from collections.abc import Mapping
from functools import cached_property
from itertools import accumulate, repeat, takewhile
from math import isfinite
from operator import mul

from lumen.errors import LumenError
from lumen.fuzzy.evaluator import Evaluator
from lumen.fuzzy.survey import Survey, asked
from lumen.language.controllers import ControllerDefinition

ZOOM_STEP = 2**0.5
"""The ratio of a magnification to the one before."""
HALVINGS = 20
"""The number of bisections in the search for the distance from which the next magnification is better."""
ONE_BY_ONE = frozenset(("general", "threshold"))
"""The activation methods with which the rules of a block do not affect each other."""

InputSide = tuple[str, bool]
"""An input, and whether it is above its neutral point."""


class Magnifier:
    """Evaluates images, magnified about the inputs' neutral points up to the `zoom` of the controller's `track:`."""

    def __init__(self, controller: ControllerDefinition) -> None:
        self._controller = controller
        self._evaluator = Evaluator(controller)
        self._neutral = {
            name: (v.minimum + v.maximum) / 2 if v.neutral is None else v.neutral
            for name, v in controller.inputs.items()
        }
        most = controller.tracking.zoom
        self._zooms = tuple(takewhile(lambda zoom: zoom <= most, accumulate(repeat(ZOOM_STEP), mul, initial=1.0)))
        self._own = _own_inputs(controller)

    def answer(self, inputs: Mapping[str, float], previous: Mapping[str, float]) -> dict[str, float]:
        """Return the outputs for an image at the best magnification; raises the same errors as `evaluate`.

        Outputs with `lock_previous` keep their value in `previous` if no rule fires.
        """
        if self._own is None or len(self._zooms) == 1:
            return self._tried(inputs, previous)
        zooms = {name: self._best(name, value) for name, value in inputs.items()}
        said = self._evaluator.evaluate(self._magnified(inputs, zooms), previous)
        return {name: value / zooms.get(self._own.get(name, ""), 1.0) for name, value in said.items()}

    def _tried(self, inputs: Mapping[str, float], previous: Mapping[str, float]) -> dict[str, float]:
        """Return for each output its value of the greatest size over all magnifications."""
        outputs: dict[str, float] = {}
        for zoom in self._zooms:
            said = self._evaluator.evaluate(self._magnified(inputs, dict.fromkeys(inputs, zoom)), previous)
            for name, value in said.items():
                if abs(value) / zoom > abs(outputs.get(name, 0.0)) or zoom == 1.0:
                    outputs[name] = value / zoom
        return outputs

    def _magnified(self, inputs: Mapping[str, float], zooms: Mapping[str, float]) -> dict[str, float]:
        """Return the magnified inputs, clipped to their ranges."""
        magnified = dict(inputs)
        for name, zoom in zooms.items():
            if zoom > 1.0:
                middle = self._neutral[name]
                magnified[name] = self._within(name, middle + zoom * (inputs[name] - middle))
        return magnified

    def _best(self, name: str, value: float) -> float:
        """Return the least magnification that brings a value far enough from its neutral point, else the greatest."""
        off = value - self._neutral[name]
        enough = self._far_enough.get((name, off > 0.0), 0.0) if off else 0.0
        return next((zoom for zoom in self._zooms if zoom * abs(off) >= enough), self._zooms[-1])

    @cached_property
    def _far_enough(self) -> dict[InputSide, float]:
        """The distance of each input from its neutral point, on either side, beyond which magnification is useless."""
        steepest: dict[InputSide, tuple[float, float, str]] = {}
        for output, name, xs, ys in Survey(self._controller).slices():
            for x, y in zip(xs, ys, strict=True):
                off = x - self._neutral[name]
                if off and isfinite(y):
                    side = name, off > 0.0
                    steepest[side] = max(steepest.get(side, (0.0, 0.0, "")), (abs(y / off), abs(off), output))
        return {side: self._turn(side, *found[1:]) for side, found in steepest.items()}

    def _turn(self, side: InputSide, steepest: float, output: str) -> float:
        """Return the distance from which magnification decreases the output; it is just below the steepest point."""
        name, above = side

        def steepness(off: float) -> float:
            x = self._within(name, self._neutral[name] + (off if above else -off))
            try:
                return abs(self._evaluator.evaluate({**self._neutral, name: x})[output]) / off
            except LumenError:  # no rule fires there
                return 0.0

        low, high = steepest / ZOOM_STEP, steepest
        for _ in range(HALVINGS):
            middle = (low + high) / 2
            nearer = steepness(middle * ZOOM_STEP) > steepness(middle)
            low, high = (middle, high) if nearer else (low, middle)
        return high

    def _within(self, name: str, x: float) -> float:
        variable = self._controller.inputs[name]
        return min(max(x, variable.minimum), variable.maximum)


def _own_inputs(controller: ControllerDefinition) -> dict[str, str] | None:
    """Return the one input on which each output depends; None if that is not a one-to-one relation.

    It is also None if rules compete, or if the range of an input is infinite.
    """
    if any(block.operators.activation.method not in ONE_BY_ONE for block in controller.blocks):
        return None
    if not all(isfinite(v.maximum - v.minimum) for v in controller.inputs.values()):
        return None
    found = {name: asked(controller, name) for name in controller.outputs}
    own = {name: next(iter(inputs)) for name, inputs in found.items() if inputs}
    alone = all(len(inputs) <= 1 for inputs in found.values()) and len(set(own.values())) == len(own)
    return own if alone else None
