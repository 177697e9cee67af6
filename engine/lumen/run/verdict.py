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
    """The result of trying a saying, with its place in the file."""

    tried: TriedSaying
    place: Place


@dataclass(frozen=True)
class JudgedExample:
    """The result of trying an example of a function, with its place in the file."""

    tried: TriedExample
    place: Place


@dataclass(frozen=True)
class Verdict:
    """The result of `lumen test`."""

    name: str
    """The name of the project."""
    rehearsals: tuple[Rehearsal, ...] = ()
    """The results of the stories."""
    coverage: Coverage | None = None
    """The coverage of the stories; None if it is not measured."""
    wanted: float = 0.0
    """The required coverage [%]."""
    explored: Explored | None = None
    """The result of the exploration; None without an exploration."""
    took: float = 0.0
    """The duration of the whole test [s]."""
    trials: tuple[QuestionTrial, ...] = ()
    """The results of the exhibition's questions, which never fail the test."""
    sayings: tuple[JudgedSaying, ...] = ()
    """The results of the sayings."""
    examples: tuple[JudgedExample, ...] = ()
    """The results of the functions' examples."""

    @property
    def failed(self) -> int:
        """The number of failed stories."""
        return sum(r.failed is not None for r in self.rehearsals)

    @property
    def misheard(self) -> list[JudgedSaying]:
        """The sayings that match another row, or whose slots have other values."""
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
        """Whether the coverage is below `wanted`."""
        return self.coverage is not None and self.coverage.percent < self.wanted

    @property
    def well(self) -> bool:
        """Whether nothing failed, the coverage suffices, and the exploration found nothing."""
        return not (self.all_failed or self.uncovered or (self.explored and self.explored.findings))
