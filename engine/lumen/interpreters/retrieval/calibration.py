"""From how alike questions are to whether one is answered: thresholds, set by questions whose answers are known."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from lumen.interpreters.retrieval.ranking import MAX_WRONG, AnswerRates, Ranked, Thresholds

STEPS = 40
"""Thresholds that are tried of each kind."""


class Sample(NamedTuple):
    """A question whose passage is known, empty where none has its answer, and what is most like it."""

    wanted: str
    ranked: Ranked

    @property
    def is_right(self) -> bool:
        """Whether its answer would be right."""
        return self.wanted == self.ranked.passage


NEVER = Thresholds(2.0, 2.0)
"""Answers nothing: where there is no question to go by."""


def outcome(samples: Sequence[Sample], thresholds: Thresholds) -> AnswerRates:
    """What becomes of these questions."""
    answered = [sample for sample in samples if thresholds.allow(sample.ranked)]
    right = sum(sample.is_right for sample in answered)
    known = sum(bool(sample.wanted) for sample in samples)
    return AnswerRates(right / max(known, 1), (len(answered) - right) / max(len(samples), 1))


def calibrate(samples: Sequence[Sample], max_wrong: float = MAX_WRONG) -> Thresholds:
    """Those that answer most of these questions rightly and at most so many wrongly; the strictest of equals."""
    if not samples:
        return NEVER
    found = _Grid(samples).best(max_wrong)
    return found[0]


def left_out(samples: Sequence[Sample], max_wrong: float = MAX_WRONG) -> AnswerRates:
    """What becomes of each of these questions by the thresholds that all others set."""
    if not samples:
        return AnswerRates(0.0, 0.0)
    chosen = _Grid(samples).best(max_wrong, each_left_out=True)
    answered = [s for s, thresholds in zip(samples, chosen, strict=True) if thresholds.allow(s.ranked)]
    right = sum(sample.is_right for sample in answered)
    return AnswerRates(right / max(sum(bool(s.wanted) for s in samples), 1), (len(answered) - right) / len(samples))


class _Grid:
    """Thresholds that are tried, strictest first, and which samples each of them answers rightly and wrongly."""

    def __init__(self, samples: Sequence[Sample]) -> None:
        scores = np.array([sample.ranked.score for sample in samples])
        margins = np.array([sample.ranked.margin for sample in samples])
        at = np.linspace(1.0, 0.0, STEPS)
        self.tried = [
            Thresholds(float(least), float(margin))
            for least in dict.fromkeys(np.quantile(scores, at))
            for margin in dict.fromkeys(np.quantile(margins, at))
        ]
        answered = np.array([(scores >= t.least) & (margins >= t.margin) for t in self.tried])
        rightly = np.array([sample.is_right for sample in samples])
        self.right, self.wrong = answered & rightly, answered & ~rightly

    def best(self, max_wrong: float, *, each_left_out: bool = False) -> list[Thresholds]:
        """The best for all samples together, or for each one those that are the best for the others."""
        right, wrong = (each.sum(axis=1, keepdims=True) for each in (self.right, self.wrong))
        count = self.right.shape[1]
        if each_left_out:
            right, wrong, count = right - self.right, wrong - self.wrong, count - 1
        allowed = np.where(wrong <= max_wrong * count, right, -1)
        rows = allowed.argmax(axis=0)
        return [self.tried[row] if allowed[row, i] >= 0 else NEVER for i, row in enumerate(rows)]
