"""Passages by what they mean: features of vectors, beside those of words."""

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from lumen.features.answers.vectors import KnownText, TextVector
from lumen.language.knowledge import Passage

if TYPE_CHECKING:
    from lumen.retrieval.features import FeatureExtractor, Method
    from lumen.retrieval.scorers import Scorer, Scores

Embed = Callable[[Sequence[KnownText]], list[TextVector]]


def by_meaning(embed: Embed) -> "Method":
    """Three features: how alike the nearest wording is, the nearest three on average, and the answer itself."""
    from lumen.retrieval.features import by_wordings, joined

    def wordings(known: Sequence[str], _: str) -> "Scorer":
        return _likeness(embed, [KnownText(text) for text in known])

    def answers(passages: Sequence[Passage], language: str) -> "FeatureExtractor":
        score = _likeness(embed, [KnownText(passage.answer[language], is_answer=True) for passage in passages])
        return lambda question: score(question)[:, None]

    return joined(by_wordings(wordings), answers)


def _likeness(embed: Embed, known: Sequence[KnownText]) -> "Scorer":
    import numpy as np  # late: who asks no embeddings does not wait for it

    rows = np.array(embed(known), np.float32)

    def score(question: str) -> "Scores":
        (vector,) = embed([KnownText(question)])
        return np.asarray(rows @ np.array(vector, np.float32), np.float32)

    return score
