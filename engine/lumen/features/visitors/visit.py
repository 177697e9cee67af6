"""The present visit, including the time before the visitor's name is known."""

from collections.abc import Callable
from typing import Any, NamedTuple

from lumen.language.people import PersonName, name_key

SILENCE = 300.0
"""The silence after which the next person counts as another visitor, if no name is known [s]."""


class JournalEnd(NamedTuple):
    """The end of an earlier run's journal."""

    visit: int = 0
    """The number of the last visit."""
    time: float = 0.0
    """The time of the last entry [s since 1970]."""
    visitor: str = ""
    """The name of the last visitor; empty if unknown."""


class Visit:
    """The present visit, with its `number` and the `visitor`'s name, which is empty while unknown.

    A visit ends when the behaviour forgets the name or learns another one. A visit without a name ends after a silence.
    If the visitor is forgotten during the visit, nothing more about them is recorded until the visit ends.
    """

    def __init__(self) -> None:
        self.number, self.visitor = 0, ""
        self._spoke, self._begun, self._met = 0.0, False, False
        self._unwanted: list[PersonName] = []
        self._muted = False

    def live(self, now: float, earlier: Callable[[], JournalEnd], *, spoken: bool) -> None:
        """Record that an entry was made at `now` [s since 1970]; after a silence, first end a visit without a name.

        `spoken` means that the entry is about the visitor. `earlier` returns the end of an earlier run's journal; only
        the first call uses it.
        """
        if not self.number:
            end = earlier()
            self.number, self._spoke, self.visitor = max(end.visit, 1), end.time, end.visitor
            self._begun = end.visit > 0
        if now - self._spoke > SILENCE and self._begun and not self.visitor:
            self._end()
        if spoken:
            self._spoke, self._begun = now, True

    def meet(self, name: str, *, stepped: bool) -> bool:
        """Record the name in the behaviour's context; return True if it is a new name for the journal.

        If the name vanished without a step of the behaviour (`stepped`), it was only removed: the visit continues.
        """
        left, self._met = stepped or not self._met, True
        if name_key(name) == name_key(self.visitor):
            return False
        if any(name_key(name) == person.key for person in self._unwanted):
            self.visitor, self._muted = name, True
            return False
        if (name or left) and (self.visitor or self._unwanted):
            self._end()
        self.visitor = name
        return bool(name)

    def forget(self, name: str) -> None:
        """Forget the present visitor if they have this name now, or get it during the visit."""
        self._unwanted.append(PersonName(name))
        self._muted = self._muted or self.is_with(name)

    def is_with(self, name: str) -> bool:
        """Return True if the visitor has this name; False if the visitor's name is unknown."""
        return bool(self.visitor) and name_key(self.visitor) == name_key(name)

    @property
    def muted(self) -> bool:
        """True if the visit belongs to a forgotten visitor."""
        return self._muted

    def names_unwanted(self, *said: Any) -> bool:
        """Return True if the values name a visitor who was forgotten during this visit."""
        return any(person.is_in(list(said)) for person in self._unwanted)

    def _end(self) -> None:
        self.number += 1
        self._unwanted, self._muted, self.visitor, self._begun = [], False, "", False
