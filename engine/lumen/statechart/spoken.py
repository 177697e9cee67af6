"""What is left of a text that was being said: from the sentence on in which it was."""

import re
from dataclasses import replace

from lumen.language.commands import BodyCommand, Say

SPEECH_RATE = 17.0
"""How many characters are said in a second, at most."""
DOUBT = 1.0
"""How much earlier it may have been [s]: a sentence said twice is better than one not heard."""

_SENTENCE = re.compile(r"(?<=[.!?…])\s+")


def rest_of(command: BodyCommand, elapsed: float) -> BodyCommand:
    """A command that begins again, `elapsed` [s] after it first began: of what is said, that sentence and the rest."""
    return replace(command, text=_rest(command.text, elapsed)) if isinstance(command, Say) else command


def _rest(text: str, elapsed: float) -> str:
    sentences = _SENTENCE.split(text)
    said = max(elapsed - DOUBT, 0.0) * SPEECH_RATE
    while len(sentences) > 1 and len(sentences[0]) < said:
        said -= len(sentences.pop(0)) + 1
    return " ".join(sentences)
