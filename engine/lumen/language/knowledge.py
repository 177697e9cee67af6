"""What the exhibition's people know, as `knowledge/NAME.yaml` or `NAME.md` says it, and what it is tried with."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from datetime import date


@dataclass(frozen=True)
class Passage:
    """One thing that is known: questions as visitors may put them, and what is spoken, both by language.

    `place` is the one of lumen.yaml that it is about, `who` the robots that may say it; empty means any. It is true
    until the end of the day `until`; `as_of` is when somebody last made sure. `file` is where it stands.
    """

    name: str
    questions: Mapping[str, tuple[str, ...]]
    answer: Mapping[str, str]
    place: str = ""
    who: tuple[str, ...] = ()
    as_of: date | None = None
    until: date | None = None
    tags: tuple[str, ...] = ()
    file: str = ""

    def is_said_by(self, robot: str) -> bool:
        """Return True if that robot may use it in an answer."""
        return not self.who or robot in self.who

    def is_past(self, today: date) -> bool:
        """Return True if the last day on which it is true is over."""
        return self.until is not None and self.until < today


@dataclass(frozen=True)
class QuestionSet:
    """Questions in other words than the passages', `knowledge/questions/NAME.yaml`: they say when one is like enough.

    `asked` are those that a passage answers, by its name and by language, `unanswered` those that none does, by
    language.
    """

    name: str
    asked: Mapping[str, Mapping[str, tuple[str, ...]]] = field(default_factory=dict)
    unanswered: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
