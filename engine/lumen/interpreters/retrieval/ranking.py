"""How alike a question and a passage are, and whether that is enough."""

from typing import NamedTuple


class Ranked(NamedTuple):
    """The passage that is most like a question, how much, and by how much more than the next one."""

    passage: str
    score: float
    margin: float


class Thresholds(NamedTuple):
    """A question is answered if its score is at least `least`, and so much better than the next one."""

    least: float
    margin: float

    def allow(self, ranked: Ranked) -> bool:
        """Whether it is answered."""
        return ranked.score >= self.least and ranked.margin >= self.margin
