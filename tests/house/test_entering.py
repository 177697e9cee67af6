"""After an object's constructor has ended, no callable enters it.

ceilings.yaml has the number of those that still do. The test lists them if that is set to 0.
"""

from collections.abc import Callable

from figures import Figure, beyond_ceilings

import lumen
from tests import ROOT
from tests.house.ceilings import ENTERING, ceilings
from tests.house.entering import watched


class Bell:
    def __init__(self, ring: Callable[[], None] = lambda: None) -> None:
        self.ring = ring
        self.listeners: list[Callable[[], None]] = []
        self._private: list[Callable[[], None]] = []

    def ring_with(self, ring: Callable[[], None]) -> None:
        self.ring = ring

    def silence(self) -> None:
        self.ring = lambda: None

    def listen(self, listener: Callable[[], None]) -> None:
        self._private.append(listener)

    def listen_to_itself(self) -> None:
        self._private.append(self.silence)


class Door:
    def __init__(self, bell: Bell) -> None:
        self.bell = bell
        self.opened = 0

    def open(self) -> None:
        self.opened += 1


def entered_after(wire: Callable[[Door], object]) -> list[str]:
    with watched(__name__) as watch:
        door = Door(Bell())
        wire(door)
        return watch.entered(door)


def test_a_callable_that_the_constructor_is_given_does_not_enter_afterwards() -> None:
    with watched(__name__) as watch:
        assert watch.entered(Door(Bell(print))) == []


def test_an_assigned_callable_enters() -> None:
    def wire(door: Door) -> None:
        door.bell.ring = door.open

    assert entered_after(wire) == ["Bell.ring: Door.open"]


def test_a_callable_in_a_list_enters() -> None:
    assert entered_after(lambda door: door.bell.listeners.append(door.open)) == ["Bell.listeners: Door.open"]


def test_a_callable_that_a_method_only_stores_enters() -> None:
    assert entered_after(lambda door: door.bell.ring_with(door.open)) == ["Bell.ring: Door.open"]


def test_a_callable_that_a_method_puts_into_a_private_list_enters() -> None:
    assert entered_after(lambda door: door.bell.listen(door.open)) == ["Bell._private: Door.open"]


def test_a_callable_that_an_object_makes_for_itself_does_not_enter() -> None:
    assert entered_after(lambda door: door.bell.silence()) == []
    assert entered_after(lambda door: door.bell.listen_to_itself()) == []


def test_classes_are_as_before_when_they_are_no_longer_watched() -> None:
    before = dict(vars(Bell))
    entered_after(lambda door: None)
    assert dict(vars(Bell)) == before


def entering_callables() -> list[str]:
    """Return the callables that enter an exhibition's parts between their constructors and the first tick's end."""
    lumen.open(ROOT).close()  # loads the modules whose classes are watched
    with watched() as watch, lumen.open(ROOT) as exhibition:
        exhibition.tick()
        return watch.entered(exhibition)


def test_no_more_callables_enter_an_exhibition() -> None:
    found = entering_callables()
    held = {name: value for name, value in ceilings().items() if name == ENTERING}
    assert beyond_ceilings({ENTERING: Figure(len(found), found)}, held) == []
