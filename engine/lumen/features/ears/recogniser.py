"""Who turns sound into words."""

from collections.abc import Sequence
from typing import NamedTuple, Protocol, runtime_checkable

from lumen.run.sound import Sound


class Recogniser(Protocol):
    """A speech recogniser; `languages` are those that it understands."""

    languages: tuple[str, ...]

    def expect(self, sentences: Sequence[Sequence[str]]) -> None:
        """From now on these are likely to be said, word by word; others may be. It may be called from any thread."""
        ...

    def recognise(self, sound: Sound) -> str:
        """What is said in it, empty where nothing is. It may take as long as it needs."""
        ...


class Hypothesis(NamedTuple):
    """A text that may have been said, and how sure that is, from 0 to 1; None where that is not known."""

    text: str
    confidence: float | None = None


@runtime_checkable
class RankingRecogniser(Protocol):
    """A recogniser that also knows what else may have been said; who inherits gets `recognise`."""

    languages: tuple[str, ...]

    def expect(self, sentences: Sequence[Sequence[str]]) -> None:
        """As of any recogniser."""
        ...

    def recognise(self, sound: Sound) -> str:
        """The likeliest of the hypotheses."""
        found = self.hypotheses(sound)
        return found[0].text if found else ""

    def hypotheses(self, sound: Sound) -> Sequence[Hypothesis]:
        """What may be said in it, the likeliest first; none where nothing is."""
        ...


def hypotheses(recogniser: Recogniser, sound: Sound) -> Sequence[Hypothesis]:
    """What a recogniser takes a sound for, the likeliest first; none where nothing is said."""
    if isinstance(recogniser, RankingRecogniser):
        return recogniser.hypotheses(sound)
    text = recogniser.recognise(sound)
    return [Hypothesis(text)] if text else []
