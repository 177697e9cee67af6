"""What `lumen test` found: how the stories went, what they left out, and what exploring came upon."""

from dataclasses import dataclass

from lumen.app.exploring import Explored
from lumen.app.rehearsal import Rehearsal
from lumen.runtime.coverage import Coverage


@dataclass(frozen=True)
class Verdict:
    """All of it; `took` is the time of the whole [s]. `wanted` is the least that has to be covered [%]."""

    name: str
    rehearsals: tuple[Rehearsal, ...] = ()
    coverage: Coverage | None = None
    wanted: float = 0.0
    explored: Explored | None = None
    took: float = 0.0

    @property
    def failed(self) -> int:
        """How many stories failed."""
        return sum(r.failed is not None for r in self.rehearsals)

    @property
    def uncovered(self) -> bool:
        """Whether less is covered than wanted."""
        return self.coverage is not None and self.coverage.percent < self.wanted

    @property
    def well(self) -> bool:
        """Whether nothing is wrong."""
        return not (self.failed or self.uncovered or (self.explored and self.explored.findings))
