"""Motions in simulation: what the robot, and others much like it, come to when they play them.

Who calls hands over a robot that stands and waits. Nothing here knows how it is simulated.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from lumen.features.simulation.trials.cases import Case
from lumen.features.simulation.trials.trial import DONE, FELL, Outcome, attempt


@dataclass(frozen=True)
class CaseResult:
    """A case, and what came of it with each robot, the first of them as the model describes it."""

    case: Case
    outcomes: Sequence[Outcome]

    @property
    def tried(self) -> Sequence[Outcome]:
        """Those that came to the motion's beginning."""
        return [outcome for outcome in self.outcomes if outcome.answer]

    def succeeded(self, outcome: Outcome) -> bool:
        """Whether the robot came to the end of it, and a passage at its first attempt."""
        late = self.case.passage and outcome.at > self.case.motion.duration + RETRIED_AFTER
        return outcome.answer == DONE and not late


RETRIED_AFTER = 1.5
"""A passage that takes so much longer than its motion was tried again [s]."""

__all__ = ["DONE", "FELL", "RETRIED_AFTER", "Case", "CaseResult", "Outcome", "attempt"]
