"""Why something happened, and why something else did not: asked of what was recorded, by taking steps again.

Nothing here runs while an exhibition does; a step taken again is the same step, and what is not kept is computed anew.
The questions are in `answers`, which is loaded when somebody asks one.
"""

from lumen.insight.explaining.history import RecordedStep, StepHistory

__all__ = ["RecordedStep", "StepHistory"]
