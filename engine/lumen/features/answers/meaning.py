"""Features for finding passages by meaning, computed from vectors and used besides features of words."""

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from lumen.features.answers.vectors import KnownText, TextVector
from lumen.language.knowledge import Passage

if TYPE_CHECKING:
    from lumen.retrieval.features import FeatureExtractor, Method
    from lumen.retrieval.scorers import Scorer, Scores

Embed = Callable[[Sequence[KnownText]], list[TextVector]]


def by_meaning(embed: Embed) -> "Method":
    """Return a method with three features of similarity in meaning.

    They are the similarity of the nearest wording, the average of the nearest three, and the similarity of the answer.
    """
    from lumen.retrieval.features import by_wordings, joined

    def wordings(known: Sequence[str], _: str) -> "Scorer":
        return _likeness(embed, [KnownText(text) for text in known])

    def answers(passages: Sequence[Passage], language: str) -> "FeatureExtractor":
        score = _likeness(embed, [KnownText(passage.answer[language], is_answer=True) for passage in passages])
        return lambda question: score(question)[:, None]

    return joined(by_wordings(wordings), answers)


def _likeness(embed: Embed, known: Sequence[KnownText]) -> "Scorer":
    import numpy as np  # imported late, because only embeddings need it

    rows = np.array(embed(known), np.float32)

    def score(question: str) -> "Scores":
        (vector,) = embed([KnownText(question)])
        return np.asarray(rows @ np.array(vector, np.float32), np.float32)

    return score
