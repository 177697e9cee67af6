"""The interface of sources of vectors: a server, a package or a folder."""

from collections.abc import Callable, Sequence
from typing import NamedTuple, Protocol

TextVector = tuple[float, ...]
"""A vector of length 1."""
MAX_LENGTH = 1_000
"""The most characters of a text that are used."""


class KnownText(NamedTuple):
    """A text: a question or wording, or an answer, which some models encode differently."""

    text: str
    is_answer: bool = False


class VectorSource(Protocol):
    """Computes vectors that are the more similar the closer two texts are in meaning."""

    is_here: bool
    """Whether it needs no network, so that the vectors of passages are computed before any question."""
    batch: int
    """The number of texts to pass at once."""

    def vectors(self, texts: Sequence[KnownText], deadline: float, wanted: Callable[[], bool]) -> list[TextVector]:
        """Return the vectors of these texts, by `deadline` (`time.monotonic`) and only while they are `wanted`.

        Raises ModuleError if they are unavailable.
        """


def unit(numbers: Sequence[float]) -> TextVector:
    """Return the vector scaled to length 1. Raises ValueError if it has no finite length above 0."""
    length = sum(number * number for number in numbers) ** 0.5
    if not numbers or not 0.0 < length < float("inf"):
        raise ValueError("the length of a vector must be above 0 and finite")
    return tuple(number / length for number in numbers)
