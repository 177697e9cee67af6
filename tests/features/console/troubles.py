"""Troubles of an exhibition while a user presses Rest: each starts at a random moment, and is repaired again."""

import signal
from collections.abc import Callable, Sequence
from random import Random
from threading import Event, Thread
from typing import NamedTuple

from tests.features.console.house import CONSOLE, ROBOT, WHOLE, House
from tests.saving import save

SORRY = 'en: "I am sorry, I did not understand that."'
PARDON = 'en: "Come again, please?"'
LONGEST = 2.5
"""Longest duration of a trouble in seconds, without the time to repair it."""


class Trouble(NamedTuple):
    """An event that may disturb Rest: how it starts, how it is repaired, and its `weight` in the random choice.

    `presses` windows press while it lasts.
    """

    name: str
    weight: int
    begin: Callable[[House], object] = lambda _house: None
    mend: Callable[[House], object] = lambda _house: None
    presses: int = 1


def save_tour(house: House) -> None:
    """Save the tour with another sentence."""
    tour = house.folder / "behaviors" / "tour.yaml"
    text = tour.read_text("utf-8")
    save(tour, text.replace(SORRY, PARDON) if SORRY in text else text.replace(PARDON, SORRY))


def dance(house: House) -> None:
    house.send("avatar.NAO.command", {"type": "motion", "method": "dance", "parameter": {}})


def restart(name: str) -> Callable[[House], None]:
    def begin(house: House) -> None:
        house.begin(name)
        house.await_robot()

    return begin


def start_broker(house: House) -> None:
    assert house.broker
    house.broker.start()
    house.await_robot()


def of_wire(verb: str) -> Callable[[House], object]:
    return lambda house: getattr(house.wire, verb)()


QUIET, LOADING, LEAVING = Trouble("nothing", 8), Trouble("a page that loads", 4), Trouble("a page that is left", 3)
EVERYWHERE = (
    QUIET,
    LOADING,
    LEAVING,
    Trouble("a saved file", 4, save_tour),
    Trouble("a dance", 4, dance),
    Trouble("network cut", 2, lambda house: house.network.cut(), lambda house: house.network.mend(), presses=3),
    Trouble("console killed", 1, lambda house: house.kill(CONSOLE), restart(CONSOLE), presses=3),
)
WITH_BROKER = (
    *EVERYWHERE,
    Trouble("wire cut", 2, of_wire("cut"), of_wire("mend"), presses=3),
    Trouble("wire lost", 2, of_wire("reset"), presses=2),
    Trouble("broker refuses", 1, of_wire("refuse"), of_wire("mend"), presses=3),
    Trouble("broker killed", 1, lambda house: house.broker and house.broker.kill(), start_broker, presses=3),
    Trouble("robot killed", 1, lambda house: house.kill(ROBOT), restart(ROBOT), presses=3),
    Trouble("robot hangs", 1, lambda h: h.signal(ROBOT, signal.SIGSTOP), lambda h: h.signal(ROBOT, signal.SIGCONT)),
)
WITHOUT_BROKER = (
    *EVERYWHERE,
    Trouble("exhibition killed", 1, lambda house: house.kill(WHOLE), restart(WHOLE), presses=3),
)


def drawn(troubles: Sequence[Trouble], draw: Random, presses: int) -> list[Trouble]:
    """Draw troubles in random order, in proportion to their weights, until they have at least `presses` presses."""
    found: list[Trouble] = []
    while sum(one.presses for one in found) < presses:
        round = [one for one in troubles for _ in range(one.weight)]
        found += draw.sample(round, len(round))
    while sum(one.presses for one in found[:-1]) >= presses:
        found.pop()
    return found


class Happening:
    """A trouble that begins `after` [s] from now on a thread, while the test presses Rest; `mend` ends it."""

    def __init__(self, trouble: Trouble, house: House, after: float) -> None:
        self._trouble, self._house, self._after = trouble, house, after
        self._thread = Thread(target=self._begin)
        self._thread.start()

    def _begin(self) -> None:
        Event().wait(self._after)
        self._trouble.begin(self._house)

    def mend(self, after: float) -> None:
        self._thread.join()
        Event().wait(after)
        self._trouble.mend(self._house)
