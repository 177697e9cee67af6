"""Fuzzy inference: Mamdani, Takagi-Sugeno and Tsukamoto, and any mixture of them."""

from collections.abc import Mapping

from lumen.interpreters.inference.evaluator import Evaluator
from lumen.interpreters.inference.explanation import Explanation, explain
from lumen.language.controllers import ControllerDefinition

__all__ = ["Evaluator", "Explanation", "explain", "infer"]


def infer(
    controller: ControllerDefinition, inputs: Mapping[str, float], previous: Mapping[str, float] | None = None
) -> dict[str, float]:
    """The outputs of a controller, once; whoever asks again keeps an `Evaluator`, which is compiled."""
    return Evaluator(controller).evaluate(inputs, previous)
