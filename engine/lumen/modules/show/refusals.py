"""What is not carried: each kind is told at once, then every ten seconds how many more; a flood fills no terminal."""

import threading
import time
from collections import Counter
from collections.abc import Callable

from lumen.language.counts import counted

TELL_PERIOD = 10.0
"""How long after a line about a place the next one comes [s]."""
MAX_PLACES = 100
"""Topics, addresses and routes that are told apart."""
OTHERS = "other places"


class Refusals:
    """Counts messages that are not carried, by where they came or should have gone. Safe from any thread."""

    def __init__(self, tell: Callable[[str], None], clock: Callable[[], float] = time.monotonic) -> None:
        self._tell, self._clock = tell, clock
        self._more: Counter[str] = Counter()
        self._why: dict[str, str] = {}
        self._told: dict[str, float] = {}
        self._changing = threading.Lock()
        self.count = 0

    def add(self, place: str, why: str) -> None:
        """One more at that place."""
        with self._changing:
            self.count += 1
            place = place if place in self._told or len(self._told) < MAX_PLACES else OTHERS
            first = place not in self._told
            if first:
                self._told[place] = self._clock()
            else:
                self._more[place] += 1
                self._why[place] = why
        if first:
            self._tell(f"a message on {place} is dropped: {why}")

    def tick(self, *, all: bool = False) -> None:
        """Tell how many more there were, where the last line was long enough ago, or `all`."""
        now = self._clock()
        with self._changing:
            due = [place for place in self._more if all or now - self._told[place] >= TELL_PERIOD]
            told = [(place, self._more.pop(place), self._why.pop(place)) for place in due]
            self._told.update(dict.fromkeys(due, now))
        for place, count, why in told:
            self._tell(f"Lumen dropped {counted(count, 'more message')} on {place}: {why}")
