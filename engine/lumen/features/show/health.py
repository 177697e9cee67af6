"""Whether a device is there: that it is gone is said once, and that it is back once it stays."""

import time
from collections.abc import Callable

STEADY = 3.0
"""How long a device has to be there until it is called back [s]: one that comes and goes is one trouble."""


class LinkHealth:
    """Tells that `device` is gone, and why, and when it is back; `tell` says the same only once until `well`."""

    def __init__(
        self,
        device: str,
        tell: Callable[[str], None],
        well: Callable[[], None],
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.device, self._tell, self._well, self._clock = device, tell, well, clock
        self._ill = False
        self._up_since: float | None = None

    def down(self, why: str) -> None:
        self._ill, self._up_since = True, None
        self._tell(f"{self.device} {why}")

    def up(self) -> None:
        if self._up_since is None:
            self._up_since = self._clock()

    def tick(self) -> None:
        if self._ill and self._up_since is not None and self._clock() - self._up_since >= STEADY:
            self._ill = False
            self._well()
            self._tell(f"{self.device} is back")
