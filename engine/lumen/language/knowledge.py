"""The knowledge of the exhibition, from `knowledge/NAME.yaml` or `NAME.md`, and the questions that test it."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import date


@dataclass(frozen=True)
class Passage:
    """One piece of knowledge: questions as visitors may ask them, and the answer to speak."""

    name: str
    """The name of the passage's file."""
    questions: Mapping[str, tuple[str, ...]]
    """The questions by language."""
    answer: Mapping[str, str]
    """The answer by language."""
    place: str = ""
    """The place in lumen.yaml that the passage is about; empty if it is about none."""
    who: tuple[str, ...] = ()
    """The robots that may use the passage; empty for all."""
    as_of: date | None = None
    """The day on which the author last checked the passage; None if unknown."""
    until: date | None = None
    """The last day on which the passage is true; None without such a day."""
    tags: tuple[str, ...] = ()
    file: str = ""
    """The path of the passage's file."""

    def is_said_by(self, robot: str) -> bool:
        """Return True if that robot may use the passage in an answer."""
        return not self.who or robot in self.who

    def is_past(self, today: date) -> bool:
        """Return True if the last day on which the passage is true is over."""
        return self.until is not None and self.until < today


@dataclass(frozen=True)
class QuestionSet:
    """The test questions of `knowledge/questions/NAME.yaml`, which tune the required similarity of questions."""

    name: str
    asked: Mapping[str, Mapping[str, tuple[str, ...]]] = field(default_factory=dict)
    """Questions that a passage answers, in other words than its own: by the passage's name and by language."""
    unanswered: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    """Questions that no passage answers, by language."""
