"""The magnification with the greatest answer counts; if it can be predicted, one evaluation is enough."""

import random
from collections.abc import Iterator, Mapping
from dataclasses import replace

import pytest

from lumen.fuzzy import Controller
from lumen.fuzzy.evaluator import Evaluator
from lumen.fuzzy.magnification import Magnifier
from lumen.language.controllers import Activation, Conjunction, ControllerDefinition, Proposition, Rule

MIDDLE = {"FaceXLoc": 160.0, "FaceYLoc": 120.0}
ZOOMS = [2 ** (k / 2) for k in range(12)]
"""Magnifications in steps of the square root of 2, below the greatest one of the shipped file, 64."""


@pytest.fixture(scope="module")
def head() -> Controller:
    return Controller.load("fuzzy/head.yaml")


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> list[Mapping[str, float]]:
    """The inputs of all later calls of `Evaluator.evaluate`."""
    asked: list[Mapping[str, float]] = []
    evaluate = Evaluator.evaluate
    monkeypatch.setattr(
        Evaluator, "evaluate", lambda self, inputs, *more: (asked.append(inputs), evaluate(self, inputs, *more))[1]
    )
    return asked


def greatest(controller: ControllerDefinition, inputs: Mapping[str, float]) -> dict[str, float]:
    """Return the greatest answer by definition: for each magnification, the answer divided by it."""
    evaluator = Evaluator(controller)
    answers = []
    for zoom in ZOOMS:
        magnified = {name: middle + zoom * (inputs[name] - middle) for name, middle in MIDDLE.items()}
        ranges = controller.inputs
        within = {name: min(max(x, ranges[name].minimum), ranges[name].maximum) for name, x in magnified.items()}
        answers.append({name: value / zoom for name, value in evaluator.evaluate(within).items()})
    return {name: max((answer[name] for answer in answers), key=abs) for name in controller.outputs}


def sights(count: int) -> Iterator[dict[str, float]]:
    """Yield faces all over the image, more of them near the middle."""
    draw = random.Random(98)
    for _ in range(count):
        near = 10 ** draw.uniform(-2.0, 0.0)
        yield {name: middle * (1.0 + near * draw.uniform(-1.0, 1.0)) for name, middle in MIDDLE.items()}


def test_one_evaluation_says_what_the_best_of_all_magnifications_says(
    head: Controller, asked: list[Mapping[str, float]]
) -> None:
    magnifier = Magnifier(head)
    magnifier.answer(MIDDLE, {}), magnifier.answer({"FaceXLoc": 0.0, "FaceYLoc": 0.0}, {})  # learns the surface
    for sight in sights(120):
        expected = greatest(head, sight)
        asked.clear()
        assert magnifier.answer(sight, {}) == pytest.approx(expected, rel=1e-5, abs=1e-12)
        assert len(asked) == 1


def test_a_lopsided_surface_is_looked_at_on_either_side_for_itself(head: Controller) -> None:
    face = head.inputs["FaceXLoc"]
    positive = replace(face.terms["Positive"], parameters=(260.0, 50.0))
    lopsided = replace(
        head, inputs={**head.inputs, "FaceXLoc": replace(face, terms={**face.terms, "Positive": positive})}
    )
    magnifier = Magnifier(lopsided)
    for sight in sights(60):
        assert magnifier.answer(sight, {}) == pytest.approx(greatest(lopsided, sight), rel=1e-5, abs=1e-12)


@pytest.mark.parametrize("method", ["general", "highest"])
def test_where_outputs_share_an_input_or_rules_compete_all_magnifications_are_tried(
    head: Controller, asked: list[Mapping[str, float]], method: str
) -> None:
    (block,) = head.blocks
    both = Rule(
        Conjunction(Proposition("FaceXLoc", "Negative"), Proposition("FaceYLoc", "Zero")),
        (Proposition("AngleX", "Positive"),),
    )
    rules = (*block.rules, both) if method == "general" else block.rules
    block = replace(block, rules=rules, operators=replace(block.operators, activation=Activation(method, 4)))
    shared = replace(head, blocks=(block,))
    magnifier = Magnifier(shared)
    for sight in sights(10):
        expected = greatest(shared, sight)
        asked.clear()
        assert magnifier.answer(sight, {}) == pytest.approx(expected, rel=1e-9, abs=1e-12)
        assert len(asked) == len(ZOOMS)


def test_without_magnification_the_image_is_taken_as_it_is(head: Controller, asked: list[Mapping[str, float]]) -> None:
    plain = Magnifier(replace(head, tracking=replace(head.tracking, zoom=1.0)))
    beyond = {"FaceXLoc": -40.0, "FaceYLoc": 130.0}
    assert plain.answer(beyond, {}) == Evaluator(head).evaluate(beyond)
    assert asked == [beyond, beyond]
