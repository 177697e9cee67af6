"""Explanations of why something happened or did not, found by taking recorded steps again.

The engine traces nothing while an exhibition runs. A step taken again has the same result, so details that were not
recorded are computed from it. The questions are in `answers`, which is imported only for a question.
"""

from lumen.insight.explaining.history import RecordedStep, StepHistory

__all__ = ["RecordedStep", "StepHistory"]
