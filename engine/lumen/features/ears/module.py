"""The audio module: recordings come in, texts go out."""

from lumen.modules.ears.ears import Ears
from lumen.modules.ears.recogniser import Hypothesis, RankingRecogniser, Recogniser

__all__ = ["Ears", "Hypothesis", "RankingRecogniser", "Recogniser"]
