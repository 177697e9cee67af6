"""The audio module: recordings come in, texts go out."""

from lumen.modules.ears.ears import Ears
from lumen.modules.ears.recogniser import Recogniser

__all__ = ["Ears", "Recogniser"]
