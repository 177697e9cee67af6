"""Questions and passages as vectors of a server's `/v1/embeddings`: which passage means what was asked."""

import json
import time
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from lumen.errors import ModuleError
from lumen.language.knowledge import Passage
from lumen.language.projects import Project
from lumen.modules.answers.http_stream import answered
from lumen.modules.answers.model_settings import ServerSettings

if TYPE_CHECKING:
    from lumen.interpreters.retrieval.features import FeatureExtractor
    from lumen.interpreters.retrieval.retriever import FoundAnswer, Retriever
    from lumen.interpreters.retrieval.scorers import Scorer, Scores

BATCH = 32
"""Texts of one request."""
MAX_BYTES = 4_000_000
"""Of an answer: 32 vectors of 4,096 numbers, written out."""
MAX_KEPT = 20_000
"""Texts whose vectors are kept."""


UNTRIED = ((20.0, 20.0, 20.0, 0.0, 10.0, 5.0), 80.0)
"""Weights by meanings and by words, and of none, where the exhibition has no questions: only the order counts."""


class MeantPassages(NamedTuple):
    """The passage that answers, if one surely does, and the answers of those that are nearest."""

    answer: "FoundAnswer | None"
    nearest: tuple[str, ...]


class Embeddings:
    """Finds passages by what a question means, as far as a server's vectors tell, and by its words.

    A passage is answered where it is as probable as the exhibition's own questions (`knowledge/questions`) say that it
    has to be: without any, none is. Vectors are kept; those of passages are asked for at the first question.
    """

    def __init__(self, settings: ServerSettings) -> None:
        self.settings = settings
        self._kept: dict[str, tuple[float, ...]] = {}
        self._deadline, self._wanted = 0.0, _always
        self._known: tuple[object, ...] = ()
        self._retriever: Retriever | None = None
        self._weights: Any = None

    def find(
        self, project: Project, question: str, language: str, deadline: float, wanted: Callable[[], bool], most: int
    ) -> MeantPassages:
        """What is known of the question, by `deadline` (`time.monotonic`). Raises ModuleError where no server says."""
        from lumen.interpreters.retrieval.features import joined, words
        from lumen.interpreters.retrieval.ranking import NEVER, Weights
        from lumen.interpreters.retrieval.retriever import Retriever
        from lumen.interpreters.retrieval.trials import weights_of

        self._deadline, self._wanted = deadline, wanted
        known = (project.knowledge, project.questions, project.robot, language)
        if self._known != known:
            passages, sets = [*project.knowledge.values()], [*project.questions.values()]
            by_language = [each.questions for each in passages]
            by_language += [texts for each in sets for texts in (*each.asked.values(), each.unanswered)]
            texts = [text for texts in by_language for text in texts.get(language, ())]
            answers = [each.answer[language] for each in passages if language in each.answer]
            self._embed([question, *texts, *answers])
            self._retriever = Retriever(passages, language, robot=project.robot, method=joined(self._meanings, words))
            self._weights = weights_of(self._retriever, sets) or Weights(*UNTRIED, NEVER)
            self._known = known
        assert self._retriever
        return MeantPassages(
            self._retriever.answer(question, self._weights),
            tuple(self._retriever.nearest(question, most, self._weights)),
        )

    def _meanings(self, passages: Sequence[Passage], language: str) -> "FeatureExtractor":
        """How alike the nearest wordings of a passage are by their meaning, and how alike its answer is."""
        from lumen.interpreters.retrieval.features import by_wordings, joined

        def to_answers(passages: Sequence[Passage], language: str) -> "FeatureExtractor":
            score = self._likeness([passage.answer[language] for passage in passages], language)
            return lambda question: score(question)[:, None]

        return joined(by_wordings(self._likeness), to_answers)(passages, language)

    def _likeness(self, known: Sequence[str], _: str) -> "Scorer":
        import numpy as np

        rows = np.array(self._embed(known), np.float32).reshape(len(known), -1)

        def score(question: str) -> "Scores":
            (vector,) = self._embed([question])
            return np.asarray(rows @ np.array(vector, np.float32), np.float32)

        return score

    def _embed(self, texts: Iterable[str]) -> list[tuple[float, ...]]:
        """The vectors of these texts, of length 1; those that are not kept are asked for, a batch at a time."""
        texts = list(texts)
        missing = [text for text in dict.fromkeys(texts) if text not in self._kept]
        if len(self._kept) + len(missing) > MAX_KEPT:
            self._kept.clear()
            missing = list(dict.fromkeys(texts))
        for i in range(0, len(missing), BATCH):
            batch = missing[i : i + BATCH]
            self._kept |= zip(batch, self._asked(batch), strict=True)
        if len({len(self._kept[text]) for text in texts}) > 1:
            self._kept.clear()
            raise ModuleError("the server of embeddings gives vectors of different lengths")
        return [self._kept[text] for text in texts]

    def _asked(self, texts: list[str]) -> list[tuple[float, ...]]:
        if time.monotonic() >= self._deadline:
            raise ModuleError("the server of embeddings did not answer in time")
        body = {"model": self.settings.name, "input": texts}
        with answered(self.settings.url, body, self.settings.secret(), self._deadline, self._wanted, MAX_BYTES) as (
            _,
            pieces,
        ):
            content = b"".join(pieces)
        try:
            data = json.loads(content)["data"]
            vectors = {row["index"]: _unit(row["embedding"]) for row in data}
            return [vectors[i] for i in range(len(texts))]
        except (ValueError, TypeError, KeyError, RecursionError, OverflowError):
            raise ModuleError("the server of embeddings answers something else than a list of embeddings") from None


def embeddings_of(options: Mapping[str, Any], before: Embeddings | None) -> Embeddings | None:
    """What the module's options say of embeddings, with what is known already; None where nothing."""
    if not isinstance(said := options.get("embeddings"), Mapping):
        return None
    settings = ServerSettings.of(said)
    return before if before and before.settings == settings else Embeddings(settings)


def _unit(numbers: Sequence[float]) -> tuple[float, ...]:
    length = sum(number * number for number in numbers) ** 0.5
    if not numbers or not 0.0 < length < float("inf"):
        raise ValueError
    return tuple(number / length for number in numbers)


def _always() -> bool:
    return True
