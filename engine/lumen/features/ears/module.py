"""The speech half of the audio module, which turns recordings into texts."""

from lumen.features.ears.ears import Ears
from lumen.features.ears.recogniser import Hypothesis, RankingRecogniser, Recogniser

__all__ = ["Ears", "Hypothesis", "RankingRecogniser", "Recogniser"]
