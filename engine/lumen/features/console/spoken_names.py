"""Names of visitors in what a robot says: left out for who has no role."""

import re

MAX_NAMES = 50
"""Names that are known at a time; a robot may still say that of a visitor who has gone."""
LEFT_OUT = "…"


class SpokenNames:
    """Remembers the names that a robot has heard or recognised lately; any thread may say one."""

    def __init__(self) -> None:
        self._names: tuple[str, ...] = ()

    def add(self, name: object) -> None:
        """Somebody is called that."""
        if isinstance(name, str) and (known := name.strip()) and known not in self._names:
            self._names = (*self._names, known)[-MAX_NAMES:]

    def without(self, text: str) -> str:
        """The text without these names, however they are written in it."""
        for name in sorted(self._names, key=len, reverse=True):  # Ani Putri before Ani
            text = re.sub(rf"(?<!\w){re.escape(name)}(?!\w)", LEFT_OUT, text, flags=re.IGNORECASE)
        return text
