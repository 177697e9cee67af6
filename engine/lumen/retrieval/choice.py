"""Which passage a question is for, or none: a conditional logit (McFadden 1974), and how probable that choice is.

Each passage is an alternative whose worth is the weighted sum of its features, and “none of them” is one more, of a
worth of its own. A question that several passages fit equally well, or none better than “none”, is probably for none.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from lumen.retrieval.features import Features
from lumen.retrieval.ranking import UNANSWERABLE

RIDGE = 1.0
"""How much weights are held back, in units of what one question tells of features of variance 1."""
NONE_RIDGE = 1e-3
"""How much the worth of “none” is."""
STEPS, ENOUGH = 60, 1e-6
"""Newton's steps at most, and how small a step is the last."""
LONGEST = 3.0
"""How far a step goes at most: far from the solution, Newton's goes too far."""


def probabilities(features: NDArray[np.float32], weights: tuple[float, ...], none: float) -> NDArray[np.float64]:
    """How probably each passage is the one, of features of shape (…, passages, features); what is left is for none."""
    worth = np.asarray(features, np.float64) @ np.array(weights)
    most = np.maximum(worth.max(axis=-1, keepdims=True, initial=-np.inf), none)
    share = np.exp(worth - most)
    found: NDArray[np.float64] = share / (share.sum(axis=-1, keepdims=True) + np.exp(none - most))
    return found


def shares(known: Sequence[bool]) -> NDArray[np.float64]:
    """How much each question counts, 1 on average, by whether it has an answer; together UNANSWERABLE have none."""
    has = np.array(known, bool)
    if has.all() or not has.any():
        return np.ones(len(has))
    counts: NDArray[np.float64] = np.where(has, (1 - UNANSWERABLE) / has.mean(), UNANSWERABLE / (~has).mean())
    return counts


def fitted(features: list[Features], wanted: list[int]) -> tuple[tuple[float, ...], float]:
    """Weights of the features, and the worth of “none”; `wanted` is a passage's row for each question, -1 for none."""
    told = np.array(features, np.float64)
    count, passages, kinds = told.shape
    middle = told.mean(axis=(0, 1))
    spread = np.maximum(told.std(axis=(0, 1)), 1e-9)
    offered = np.zeros((count, passages + 1, kinds + 1))
    offered[:, :passages, 1:] = (told - middle) / spread
    offered[:, passages, 0] = 1.0
    counts = shares([row >= 0 for row in wanted])
    chosen = offered[np.arange(count), np.where(np.array(wanted) < 0, passages, wanted)]
    ridge = np.diag([NONE_RIDGE, *[RIDGE] * kinds])
    solution = np.zeros(kinds + 1)
    for _ in range(STEPS):
        worth = offered @ solution
        share = np.exp(worth - worth.max(axis=1, keepdims=True))
        share /= share.sum(axis=1, keepdims=True)
        mean = (share[:, None, :] @ offered)[:, 0]
        slope = counts @ (chosen - mean) - ridge @ solution
        flat = offered.reshape(-1, kinds + 1)
        bend = (flat * (share * counts[:, None]).reshape(-1, 1)).T @ flat - (mean.T * counts) @ mean + ridge
        step = np.linalg.solve(bend, slope)
        longest = float(np.abs(step).max())
        solution += step * min(1.0, LONGEST / max(longest, 1e-12))
        if longest < ENOUGH:
            break
    weights = solution[1:] / spread
    return tuple(weights.tolist()), float(solution[0] + weights @ middle)
