"""The findings of `lumen test`: stories, sayings, examples and questions, coverage, and exploration."""

from dataclasses import dataclass

from lumen.insight.explaining.function_examples import TriedExample
from lumen.insight.explaining.sayings import TriedSaying
from lumen.language.diagnostics import Place
from lumen.retrieval.ranking import QuestionTrial
from lumen.run.coverage import Coverage
from lumen.run.exploring import Explored
from lumen.run.rehearsal import Rehearsal


@dataclass(frozen=True)
class JudgedSaying:
    """A saying that was tried, and its place in its file."""

    tried: TriedSaying
    place: Place


@dataclass(frozen=True)
class JudgedExample:
    """An example of a function that was tried, and its place in its file."""

    tried: TriedExample
    place: Place


@dataclass(frozen=True)
class Verdict:
    """All of it; `took` is the time of the whole [s]. `wanted` is the least that has to be covered [%].

    `trials` is what became of the exhibition's questions, which fails nothing.
    """

    name: str
    rehearsals: tuple[Rehearsal, ...] = ()
    coverage: Coverage | None = None
    wanted: float = 0.0
    explored: Explored | None = None
    took: float = 0.0
    trials: tuple[QuestionTrial, ...] = ()
    sayings: tuple[JudgedSaying, ...] = ()
    examples: tuple[JudgedExample, ...] = ()

    @property
    def failed(self) -> int:
        """How many stories failed."""
        return sum(r.failed is not None for r in self.rehearsals)

    @property
    def misheard(self) -> list[JudgedSaying]:
        """The sayings that another row takes, or that something else is caught of."""
        return [one for one in self.sayings if one.tried.wrong]

    @property
    def refuted(self) -> list[JudgedExample]:
        """The examples of functions that give another value."""
        return [one for one in self.examples if one.tried.wrong]

    @property
    def all_failed(self) -> int:
        """The number of stories, sayings and examples that failed."""
        return self.failed + len(self.misheard) + len(self.refuted)

    @property
    def uncovered(self) -> bool:
        """Whether less is covered than wanted."""
        return self.coverage is not None and self.coverage.percent < self.wanted

    @property
    def well(self) -> bool:
        """Whether nothing is wrong."""
        return not (self.all_failed or self.uncovered or (self.explored and self.explored.findings))
