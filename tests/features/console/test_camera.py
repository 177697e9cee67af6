"""The console passes on only the newest image of a camera, only pictures, and only while a page shows it."""

import asyncio
import base64
import http.client
import threading
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import pytest

from lumen.bus.memory import MemoryBus
from lumen.errors import BusUnreachableError
from lumen.features.console import camera
from lumen.features.console.camera import Cameras, jpeg_in
from lumen.ports import Bus, MessageHandler
from tests.features.console.conftest import Hosted
from tests.features.console.pages import Browser, Served
from tests.waiting import HANG, UNLIMITED, until

JPEG = b"\xff\xd8\xff\xe0picture\xff\xd9"
KEY = "avatar.NAO.data.image"


def image(data: bytes) -> dict[str, str]:
    url = "data:image/jpeg;base64," + base64.b64encode(data).decode()
    return {"name": "1", "contentType": "image/jpeg", "contentUrl": url}


def test_only_pictures_are_shown() -> None:
    assert jpeg_in(image(JPEG)) == JPEG
    for body in (None, {}, image(b"<script>"), {"contentUrl": "data:text/html;base64,AAAA"}, {"contentUrl": "x"}):
        assert jpeg_in(body) is None


def test_images_come_while_somebody_looks(
    served: Served, hosted: Hosted, browser: Browser, monkeypatch: pytest.MonkeyPatch
) -> None:
    fresh, linger = camera.FRESH, camera.LINGER
    cameras, bus = served.console.site.sights.cameras, hosted.exhibition.node.bus
    ending = threading.Event()

    def send() -> None:
        while not ending.wait(0.02):
            bus.publish(KEY, image(JPEG))

    sender = threading.Thread(target=send)
    sender.start()
    try:
        assert not cameras.looked_at("NAO")
        connection = http.client.HTTPConnection(browser.host, browser.port, timeout=HANG)
        connection.request("GET", "/camera/NAO")
        answer = connection.getresponse()
        assert answer.getheader("content-type", "").startswith("multipart/x-mixed-replace")
        assert JPEG in answer.read(400)
        assert cameras.looked_at("NAO")
        answer.close()
        connection.close()
        until(lambda: not cameras.looked_at("NAO"))
        monkeypatch.setattr(camera, "FRESH", UNLIMITED)
        monkeypatch.setattr(camera, "LINGER", UNLIMITED)
        until(lambda: browser.get("/camera/NAO?still").status == 200)
        still = browser.get("/camera/NAO?still")
        assert (still.headers["content-type"], still.body) == ("image/jpeg", JPEG)
        assert cameras.looked_at("NAO")
        monkeypatch.setattr(camera, "FRESH", fresh)
        monkeypatch.setattr(camera, "LINGER", linger)
        browser.get("/camera/NAO?still")  # the last look ends after the usual time
        until(lambda: not cameras.looked_at("NAO"))
    finally:
        ending.set()
        sender.join()
    until(lambda: browser.get("/camera/NAO?still").status == 204)  # what was seen long ago is not shown
    assert browser.get("/camera/NAO7?still").status == browser.get("/camera/NAO7").status == 404


class SlowBus(MemoryBus):
    """A bus on which a subscription takes until `go`; `ended` is set when it is undone."""

    def __init__(self) -> None:
        super().__init__()
        self.begun, self.go, self.ended = threading.Event(), threading.Event(), threading.Event()

    def subscribe(self, pattern: str, handler: MessageHandler) -> Callable[[], None]:
        self.begun.set()
        assert self.go.wait(HANG)
        undo = super().subscribe(pattern, handler)
        return lambda: (undo(), self.ended.set())[0]


class AwayBus(MemoryBus):
    """A bus whose broker can't be reached at first."""

    away = True

    def subscribe(self, pattern: str, handler: MessageHandler) -> Callable[[], None]:
        if self.away:
            raise BusUnreachableError("the broker is away")
        return super().subscribe(pattern, handler)


def cameras_on(bus: Bus) -> Cameras:
    """Return the cameras of a console that is connected to this bus."""
    watch: Any = SimpleNamespace(
        link=SimpleNamespace(bus=bus), keys=SimpleNamespace(of=lambda robot: SimpleNamespace(image=KEY))
    )
    return Cameras(watch)


def test_a_page_that_is_closed_during_its_subscription_leaves_none(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(camera, "LINGER", 0.0)
    bus = SlowBus()
    cameras = cameras_on(bus)

    async def look() -> bool:
        viewer = asyncio.ensure_future(anext(cameras.stream("NAO")))
        assert await asyncio.to_thread(bus.begun.wait, HANG)
        viewer.cancel()
        async with asyncio.timeout(HANG):
            while cameras.looked_at("NAO"):
                await asyncio.sleep(0)
        bus.go.set()
        return await asyncio.to_thread(bus.ended.wait, HANG)

    assert asyncio.run(look())


def test_a_camera_is_asked_for_again_when_its_bus_is_back() -> None:
    bus = AwayBus()
    cameras = cameras_on(bus)

    async def look() -> bool:
        await cameras.still("NAO")
        return cameras.looked_at("NAO")

    assert not asyncio.run(look())
    bus.away = False
    assert asyncio.run(look())
