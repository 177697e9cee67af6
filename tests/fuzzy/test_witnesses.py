"""scikit-fuzzy on the head controller: a second oracle, with its own integration."""

import numpy as np
import pytest
from skfuzzy import defuzz, gaussmf, interp_membership

from lumen.fuzzy import Controller

POINTS = 20_001


def scikit_fuzzy(head: Controller, output: str, x: float) -> float:
    """Return the centroid of an output of one input, by scikit-fuzzy's own functions."""
    variable = head.outputs[output]
    universe = np.linspace(variable.minimum, variable.maximum, POINTS)
    whole = np.zeros(POINTS)
    for rule in head.rules:
        (concluded,) = rule.consequents
        if concluded.variable == output:
            asked = head.inputs[rule.antecedent.variable]  # type: ignore[union-attr]
            over = np.linspace(asked.minimum, asked.maximum, POINTS)
            term = asked.terms[rule.antecedent.term]  # type: ignore[union-attr]
            degree = interp_membership(over, gaussmf(over, *term.parameters), x)
            whole = np.fmax(whole, np.fmin(degree, gaussmf(universe, *variable.terms[concluded.term].parameters)))
    return float(defuzz(universe, whole, "centroid"))


@pytest.mark.slow
@pytest.mark.parametrize(("name", "output"), [("FaceXLoc", "AngleX"), ("FaceYLoc", "AngleY")])
def test_scikit_fuzzy_says_the_same_of_the_head_controller(name: str, output: str) -> None:
    head = Controller.load("fuzzy/head.yaml")
    rest = {n: float(v.neutral or 0.0) for n, v in head.inputs.items()}
    for x in np.linspace(head.inputs[name].minimum, head.inputs[name].maximum, 21):
        ours = head.evaluate({**rest, name: float(x)})[output]
        assert ours == pytest.approx(scikit_fuzzy(head, output, float(x)), abs=1e-4)
