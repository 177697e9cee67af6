"""The choice of the passage for a question, or of none, by a conditional logit (McFadden 1974), with its probability.

Each passage is an alternative whose utility is the weighted sum of its features; “none of them” is one more, with a
utility of its own. A question that several passages fit equally well, or none better than “none”, probably has no
passage.
"""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from lumen.retrieval.features import Features
from lumen.retrieval.ranking import UNANSWERABLE

RIDGE = 1.0
"""The ridge penalty on the weights of features that are scaled to variance 1."""
NONE_RIDGE = 1e-3
"""The ridge penalty on the utility of “none”."""
STEPS, ENOUGH = 60, 1e-6
"""The greatest number of Newton steps, and the size of a step below which the method stops."""
LONGEST = 3.0
"""The longest step: far from the solution, Newton's method overshoots."""


def probabilities(features: NDArray[np.float32], weights: tuple[float, ...], none: float) -> NDArray[np.float64]:
    """Return each passage's probability, from features of shape (…, passages, features); “none” has the rest."""
    worth = np.asarray(features, np.float64) @ np.array(weights)
    most = np.maximum(worth.max(axis=-1, keepdims=True, initial=-np.inf), none)
    share = np.exp(worth - most)
    found: NDArray[np.float64] = share / (share.sum(axis=-1, keepdims=True) + np.exp(none - most))
    return found


def shares(known: Sequence[bool]) -> NDArray[np.float64]:
    """Return the weight of each question, 1 on average, so that those without an answer have the share UNANSWERABLE.

    All weights are 1 if the questions are all of one kind.
    """
    has = np.array(known, bool)
    if has.all() or not has.any():
        return np.ones(len(has))
    counts: NDArray[np.float64] = np.where(has, (1 - UNANSWERABLE) / has.mean(), UNANSWERABLE / (~has).mean())
    return counts


def fitted(features: list[Features], wanted: list[int]) -> tuple[tuple[float, ...], float]:
    """Fit and return the weights of the features, and the utility of “none”, by Newton's method.

    `wanted` is the row of the right passage of each question, -1 for none.
    """
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
