"""Reports that a device is gone, and that it is back when it stays connected."""

import time
from collections.abc import Callable

STEADY = 3.0
"""The time for which a device must stay connected before it is reported as back [s].

An unstable connection is thus reported only once.
"""


class LinkHealth:
    """Reports that `device` is gone, with the reason, and that it is back.

    `tell` prints each line only once until `well` is called.
    """

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
        """Report that the device is gone, with the reason `why`."""
        self._ill, self._up_since = True, None
        self._tell(f"{self.device} {why}")

    def up(self) -> None:
        """Record that the device is connected."""
        if self._up_since is None:
            self._up_since = self._clock()

    def tick(self) -> None:
        """Report that the device is back if it has been connected long enough."""
        if self._ill and self._up_since is not None and self._clock() - self._up_since >= STEADY:
            self._ill = False
            self._well()
            self._tell(f"{self.device} is back")
