"""The speech half of the audio module: recordings come in, texts go out."""

from lumen.features.ears.ears import Ears
from lumen.features.ears.recogniser import Hypothesis, RankingRecogniser, Recogniser

__all__ = ["Ears", "Hypothesis", "RankingRecogniser", "Recogniser"]
