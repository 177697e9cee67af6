"""The newest camera image of each robot, subscribed to only while a page shows it."""

import asyncio
import base64
import binascii
import time
from collections.abc import AsyncIterator, Callable, Iterator
from contextlib import contextmanager, suppress
from typing import Any

from lumen.errors import BusError
from lumen.features.console.watch import Watch
from lumen.ports import Bus, Message

BOUNDARY = "lumen-frame"
MEDIA_TYPE = f"multipart/x-mixed-replace; boundary={BOUNDARY}"
JPEG = "data:image/jpeg;base64,"
MAX_IMAGE = 4_000_000
"""The maximum length of an image on the bus [characters]."""
PERIOD = 1 / 15
"""The minimum time between two images of a stream [s]."""
SILENCE = 10.0
"""A stream ends after this long without an image [s]."""
FRESH = 2.0
"""The maximum age of a still image [s]."""
LINGER = 2.0
"""The subscription remains for this long after the last viewer has left [s]."""


class WatchedCamera:
    """The newest image of one robot: `frame` is its JPEG data, empty while `count`, the number of images, is 0."""

    def __init__(self) -> None:
        self.frame, self.count, self.lookers = b"", 0, 0
        self.at = self.wanted = -FRESH
        self.bus: Bus | None = None
        self.came = asyncio.Event()
        self._loop = asyncio.get_running_loop()
        self._undo: asyncio.Future[Callable[[], None]] | None = None

    async def listen(self, bus: Bus, key: str) -> None:
        """Subscribe to the images on a bus. Raises BusError if the bus can't be reached."""
        self.bus = bus
        self._undo = asyncio.ensure_future(asyncio.to_thread(bus.subscribe, key, self._take))
        await asyncio.shield(self._undo)  # a viewer who leaves meanwhile does not lose the way to end it

    def leave(self) -> None:
        """End the subscription, at once or when it has been made."""
        self.bus, undo, self._undo = None, self._undo, None
        if undo:
            undo.add_done_callback(self._end)

    def _end(self, undo: "asyncio.Future[Callable[[], None]]") -> None:
        if not undo.cancelled() and not undo.exception():
            self._loop.run_in_executor(None, undo.result())

    def _take(self, message: Message) -> None:
        if (frame := jpeg_in(message.body)) is not None:
            with suppress(RuntimeError):  # the loop has ended
                self._loop.call_soon_threadsafe(self.show, frame)

    def show(self, frame: bytes) -> None:
        self.frame, self.count, self.at = frame, self.count + 1, time.monotonic()
        self.came.set()
        self.came = asyncio.Event()


class Cameras:
    """The cameras of all robots of a watch."""

    def __init__(self, watch: Watch) -> None:
        self._watch = watch
        self._cameras: dict[str, WatchedCamera] = {}
        self._closing = False

    def close(self) -> None:
        self._closing = True
        for camera in self._cameras.values():
            camera.came.set()

    def looked_at(self, robot: str) -> bool:
        """Return True while the console is subscribed to the images of a robot."""
        return robot in self._cameras and self._cameras[robot].bus is not None

    async def stream(self, robot: str) -> AsyncIterator[bytes]:
        """Yield the newest images as parts of a multipart response.

        The stream ends after SILENCE [s] without an image, or when the console closes.
        """
        with self._looking(robot) as camera:
            seen = camera.count
            while not self._closing:
                if camera.count != seen:
                    seen = camera.count
                    head = f"--{BOUNDARY}\r\nContent-Type: image/jpeg\r\nContent-Length: {len(camera.frame)}\r\n\r\n"
                    yield head.encode() + camera.frame + b"\r\n"
                    await asyncio.sleep(PERIOD)
                await self._listen(robot, camera)
                try:
                    async with asyncio.timeout(SILENCE):
                        while camera.count == seen and not self._closing:
                            await camera.came.wait()
                except TimeoutError:
                    return

    async def still(self, robot: str) -> bytes:
        """Return the newest image, empty if there is none or it is older than FRESH [s].

        The subscription remains for LINGER [s], so a later call can return an image.
        """
        with self._looking(robot) as camera:
            await self._listen(robot, camera)
        return camera.frame if time.monotonic() - camera.at < FRESH else b""

    async def _listen(self, robot: str, camera: WatchedCamera) -> None:
        """Subscribe to the images on the current bus, if any, unless already subscribed.

        If the bus can't be reached, the next call tries again.
        """
        if (bus := self._watch.link.bus) is None or bus is camera.bus:
            return
        try:
            await camera.listen(bus, self._watch.keys.of(robot).image)
        except BusError:
            camera.leave()

    @contextmanager
    def _looking(self, robot: str) -> Iterator[WatchedCamera]:
        """Count a viewer of a robot's camera; after LINGER [s] without one, end the subscription."""
        camera = self._cameras.setdefault(robot, WatchedCamera())
        camera.lookers += 1
        try:
            yield camera
        finally:
            camera.lookers -= 1
            camera.wanted = time.monotonic()
            asyncio.get_running_loop().call_later(LINGER, self._leave, camera)

    def _leave(self, camera: WatchedCamera) -> None:
        if not camera.lookers and time.monotonic() - camera.wanted >= LINGER * 0.9:
            camera.leave()


def jpeg_in(body: Any) -> bytes | None:
    """Return the JPEG data in a message; None if it is missing, malformed or longer than MAX_IMAGE."""
    url = body.get("contentUrl") if isinstance(body, dict) else None
    if not isinstance(url, str) or not url.startswith(JPEG) or len(url) > MAX_IMAGE:
        return None
    try:
        found = base64.b64decode(url[len(JPEG) :], validate=True)
    except (binascii.Error, ValueError):
        return None
    return found if found.startswith(b"\xff\xd8") else None
