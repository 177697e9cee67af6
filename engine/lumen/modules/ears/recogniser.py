"""Who turns sound into words."""

from typing import Protocol

from lumen.modules.sound import Sound


class Recogniser(Protocol):
    """A speech recogniser; `languages` are those that it understands."""

    languages: tuple[str, ...]

    def recognise(self, sound: Sound) -> str:
        """What is said in it, empty where nothing is. It may take as long as it needs."""
        ...
