"""Who turns sound into words."""

from collections.abc import Sequence
from typing import Protocol

from lumen.modules.sound import Sound


class Recogniser(Protocol):
    """A speech recogniser; `languages` are those that it understands."""

    languages: tuple[str, ...]

    def expect(self, sentences: Sequence[Sequence[str]]) -> None:
        """From now on these are likely to be said, word by word; others may be. It may be called from any thread."""
        ...

    def recognise(self, sound: Sound) -> str:
        """What is said in it, empty where nothing is. It may take as long as it needs."""
        ...
