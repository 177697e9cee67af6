"""Something has changed: told to everybody who waits, in the loop of the console."""

import asyncio


class Changes:
    """Counts changes; `wait` returns when there was one since `seen`."""

    def __init__(self) -> None:
        self.count = 0
        self._next = asyncio.Event()

    def tell(self) -> None:
        """There was one; in the loop."""
        self.count += 1
        self._next.set()
        self._next = asyncio.Event()

    async def wait(self, seen: int, timeout: float) -> bool:
        """Whether there was one after the first `seen`, at most `timeout` [s] from now."""
        if self.count != seen:
            return True
        try:
            await asyncio.wait_for(self._next.wait(), timeout)
        except TimeoutError:
            return False
        return True
