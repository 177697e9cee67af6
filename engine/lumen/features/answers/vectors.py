"""The interface of vector sources: a server, a package or a folder."""

from collections.abc import Callable, Sequence
from typing import NamedTuple, Protocol

TextVector = tuple[float, ...]
"""A vector of length 1."""
MAX_LENGTH = 1_000
"""The maximum number of characters that are used, from the beginning of a text."""


class KnownText(NamedTuple):
    """A question or wording, or an answer, which some models encode differently."""

    text: str
    is_answer: bool = False


class VectorSource(Protocol):
    """Computes vectors that are more similar for texts that are closer in meaning."""

    is_here: bool
    """True if the source needs no network, so passages' vectors can be computed before any question."""
    batch: int
    """The maximum number of texts per call of `vectors`."""

    def vectors(self, texts: Sequence[KnownText], deadline: float, wanted: Callable[[], bool]) -> list[TextVector]:
        """Return the vectors of these texts, by `deadline` (`time.monotonic`) and only while `wanted` returns True.

        Raises ModuleError if the vectors are unavailable.
        """


def unit(numbers: Sequence[float]) -> TextVector:
    """Return the vector scaled to length 1. Raises ValueError if its length is 0 or not finite."""
    length = sum(number * number for number in numbers) ** 0.5
    if not numbers or not 0.0 < length < float("inf"):
        raise ValueError("the length of a vector must be above 0 and finite")
    return tuple(number / length for number in numbers)
