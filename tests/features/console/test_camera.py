"""The console passes on only the newest image of a camera, only pictures, and only while a page shows it."""

import base64
import http.client
import threading

import pytest

from lumen.features.console import camera
from lumen.features.console.camera import jpeg_in
from tests.features.console.conftest import Hosted
from tests.features.console.pages import Browser, Served
from tests.waiting import HANG, until

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
        monkeypatch.setattr(camera, "FRESH", HANG)
        monkeypatch.setattr(camera, "LINGER", HANG)
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
