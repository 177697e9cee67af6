"""Whose visit it is, from where it began, before anybody knew a name, to its end."""

from collections.abc import Callable
from typing import Any, NamedTuple

from lumen.language.people import PersonName, name_key

SILENCE = 300.0
"""After how long without a word whoever comes next is somebody else [s], where nobody has a name."""


class JournalEnd(NamedTuple):
    """Where an earlier run of the memory stopped: in which visit, when [s since 1970], and who that was."""

    visit: int = 0
    time: float = 0.0
    visitor: str = ""


class Visit:
    """The visit that goes on: its `number`, and the `visitor`, whose name is empty while it is unknown.

    A visit ends where the behaviour forgets the name or knows another one; without a name, after a silence. Of somebody
    who was forgotten during their visit nothing more is noted while it lasts.
    """

    def __init__(self) -> None:
        self.number, self.visitor = 0, ""
        self._spoke, self._begun, self._met = 0.0, False, False
        self._unwanted: list[PersonName] = []
        self._muted = False

    def live(self, now: float, earlier: Callable[[], JournalEnd], *, spoken: bool) -> None:
        """Something happens at `now` [s since 1970]; `earlier` is asked once."""
        if not self.number:
            end = earlier()
            self.number, self._spoke, self.visitor = max(end.visit, 1), end.time, end.visitor
            self._begun = end.visit > 0
        if now - self._spoke > SILENCE and self._begun and not self.visitor:
            self._end()
        if spoken:
            self._spoke, self._begun = now, True

    def meet(self, name: str, *, stepped: bool) -> bool:
        """The behaviour knows this name now; whether that is news to be noted.

        Without a step of it (`stepped`) it has not left anybody: the name was taken from it.
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
        """Whoever is here now is to be forgotten, and is called that name, or will be."""
        self._unwanted.append(PersonName(name))
        self._muted = self._muted or self.is_with(name)

    def is_with(self, name: str) -> bool:
        return bool(self.visitor) and name_key(self.visitor) == name_key(name)

    @property
    def muted(self) -> bool:
        """Whether it is the visit of somebody who was forgotten."""
        return self._muted

    def names_unwanted(self, *said: Any) -> bool:
        """Whether this names somebody who was forgotten during this visit."""
        return any(person.is_in(list(said)) for person in self._unwanted)

    def _end(self) -> None:
        self.number += 1
        self._unwanted, self._muted, self.visitor, self._begun = [], False, "", False
