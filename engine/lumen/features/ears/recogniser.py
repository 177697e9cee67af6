"""The interface of speech recognisers."""

from collections.abc import Sequence
from typing import NamedTuple, Protocol, runtime_checkable

from lumen.run.sound import Sound


class Recogniser(Protocol):
    """A speech recogniser; `languages` are the codes of the languages that it understands."""

    languages: tuple[str, ...]

    def expect(self, sentences: Sequence[Sequence[str]]) -> None:
        """Set the sentences, as words, that are likely to be said; others remain possible.

        Any thread may call this.
        """
        ...

    def recognise(self, sound: Sound) -> str:
        """Return the text of a sound, empty if nothing is said. The call has no time limit."""
        ...


class Hypothesis(NamedTuple):
    """A possible text of a sound."""

    text: str
    confidence: float | None = None
    """The text's probability, from 0 to 1; None if unknown."""


@runtime_checkable
class RankingRecogniser(Protocol):
    """A recogniser with alternatives; subclasses inherit `recognise`."""

    languages: tuple[str, ...]

    def expect(self, sentences: Sequence[Sequence[str]]) -> None:
        """Set the sentences that are likely to be said, as for any recogniser."""
        ...

    def recognise(self, sound: Sound) -> str:
        """Return the text of the best hypothesis, empty if there is none."""
        found = self.hypotheses(sound)
        return found[0].text if found else ""

    def hypotheses(self, sound: Sound) -> Sequence[Hypothesis]:
        """Return the likely texts of a sound, the best first; none if nothing is said."""
        ...


def hypotheses(recogniser: Recogniser, sound: Sound) -> Sequence[Hypothesis]:
    """Return a recogniser's hypotheses for a sound, the best first; none if nothing is said."""
    if isinstance(recogniser, RankingRecogniser):
        return recogniser.hypotheses(sound)
    text = recogniser.recognise(sound)
    return [Hypothesis(text)] if text else []
