"""Where the vectors of texts come from: the seam of a server, a package and a folder."""

from collections.abc import Callable, Sequence
from typing import NamedTuple, Protocol

TextVector = tuple[float, ...]
"""Of length 1."""
MAX_LENGTH = 1_000
"""Characters of a text that are looked at."""


class KnownText(NamedTuple):
    """A question or a wording; or an answer, which some models take another way."""

    text: str
    is_answer: bool = False


class VectorSource(Protocol):
    """Makes vectors that are the more alike the more two texts mean the same.

    `is_here` says that it needs no network: the vectors of passages are made before anybody asks. `batch` is how many
    texts it is given at once.
    """

    is_here: bool
    batch: int

    def vectors(self, texts: Sequence[KnownText], deadline: float, wanted: Callable[[], bool]) -> list[TextVector]:
        """Those of these texts, by `deadline` (`time.monotonic`) and only while they are `wanted`.

        Raises ModuleError where they can't be had.
        """


def unit(numbers: Sequence[float]) -> TextVector:
    """The same direction, of length 1. Raises ValueError where there is none."""
    length = sum(number * number for number in numbers) ** 0.5
    if not numbers or not 0.0 < length < float("inf"):
        raise ValueError("the length of a vector must be above 0 and finite")
    return tuple(number / length for number in numbers)
