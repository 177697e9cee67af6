"""The eyes' window: a browser gets the images with the faces that were found."""

import http.client
import socket
from collections.abc import Callable, Iterator
from contextlib import suppress
from io import BytesIO
from select import select
from urllib.parse import urlsplit

import numpy as np
import pytest
from PIL import Image

from lumen.errors import ModuleError
from lumen.features.eyes.detector import Box
from lumen.features.eyes.module import Eyes
from lumen.features.eyes.window import Window
from lumen.features.eyes.window_server import MAX_CONNECTIONS, WindowPage
from tests.features.conftest import Stand, with_options
from tests.features.eyes.test_eyes import body, photographed
from tests.waiting import HANG, until

pytestmark = pytest.mark.rest  # expensive

__all__ = ["photographed"]


def looking(address: str, **headers: str) -> http.client.HTTPResponse:
    where = urlsplit(address)
    assert where.hostname
    connection = http.client.HTTPConnection(where.hostname, where.port, timeout=HANG)
    connection.request("GET", where.path, headers=headers)
    return connection.getresponse()


def picture(page: http.client.HTTPResponse) -> np.ndarray:
    """Return the next picture of the film."""
    assert page.readline() == b"--frame\r\n"
    assert page.readline() == b"Content-Type: image/jpeg\r\n"
    length = int(page.readline().partition(b":")[2])
    assert page.readline() == b"\r\n"
    data = page.read(length)
    assert page.readline() == b"\r\n"
    return np.asarray(Image.open(BytesIO(data)).convert("RGB"))


@pytest.fixture
def window() -> Iterator[Window]:
    window = Window(0)
    yield window
    window.close()


def test_shows_faces_and_people_in_their_frames(window: Window) -> None:
    grey = np.full((240, 320), 90, np.uint8)
    window.show(grey, [], [], "nobody looks: nothing is drawn")
    page = looking(window.address)
    until(lambda: window._lookers)
    window.show(grey, [Box(100.0, 50.0, 40.0, 40.0)], [Box(200.0, 20.0, 60.0, 180.0)], "face 120 70: Budi")
    seen = picture(page).astype(int)
    assert page.headers["Content-Type"] == "multipart/x-mixed-replace; boundary=frame"
    assert page.headers["Cross-Origin-Resource-Policy"] == "same-origin", (
        "a page of another site could show the picture"
    )
    assert seen.shape == (240, 320, 3)
    assert seen[70, 100, 1] - seen[70, 100, 0] > 60, "the face has a green frame"
    assert seen[100, 200, 2] - seen[100, 200, 0] > 60, "a person has a blue one"
    assert seen[225:238, 5:140].max() > 180, "and the words stand below"
    page.close()


def test_who_goes_is_not_shown_any_more(window: Window) -> None:
    page = looking(window.address)
    until(lambda: window._lookers == 1)
    page.close()

    def gone() -> bool:
        window.show(np.zeros((240, 320), np.uint8), [], [], "")
        return window._lookers == 0

    until(gone)


def test_a_port_that_is_taken_is_one_line() -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        with pytest.raises(ModuleError, match="window cannot be opened on port") as error:
            Window(taken.getsockname()[1])
        assert "\n" not in str(error.value)


def test_nobody_is_shown_anything_without_the_token_or_by_another_name(window: Window) -> None:
    where = urlsplit(window.address)
    bare = f"http://{where.netloc}/"
    assert len(where.path.strip("/")) >= 20
    assert [looking(bare + path).status for path in ("", "x", where.path.strip("/") + "x")] == [404] * 3
    for name in ("evil.example", f"evil.example:{where.port}", "127.0.0.1", f"127.0.0.1:{where.port}, x", ""):
        assert looking(window.address, Host=name).status == 421, name
    page = looking(window.address, Host=f"localhost:{where.port}")
    assert page.status == 200
    page.close()


def test_an_address_is_good_for_one_start(window: Window) -> None:
    other = Window(0)
    other.close()
    assert urlsplit(other.address).path != urlsplit(window.address).path


def test_who_is_slow_is_hung_up_on(window: Window, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(WindowPage, "timeout", 0.2)
    with socket.create_connection(("127.0.0.1", urlsplit(window.address).port), timeout=HANG) as slow:
        with suppress(OSError):  # always something, and never a request
            until(lambda: select([slow], [], [], 0.05)[0], meanwhile=lambda: slow.sendall(b"G"), what="its hanging up")
        with suppress(ConnectionError):
            assert slow.recv(1) == b""


def test_a_ninth_is_closed_and_finds_a_place_once_another_has_gone(window: Window) -> None:
    pages = [looking(window.address) for _ in range(MAX_CONNECTIONS)]
    with pytest.raises((http.client.RemoteDisconnected, ConnectionError)):
        looking(window.address)
    pages.pop().close()

    def let_in() -> bool:
        with suppress(http.client.RemoteDisconnected, ConnectionError):
            pages.append(looking(window.address))
        return len(pages) == MAX_CONNECTIONS

    until(let_in)
    for page in pages:
        page.close()


@pytest.mark.slow
def test_the_eyes_show_what_they_found(stand: Callable[..., Stand], photographed: np.ndarray) -> None:
    here = stand()
    here = stand(with_options(here.project, "eyes", window=0))
    eyes = Eyes(here.project, here.bus, here.told.append, None)
    here.add(eyes)
    assert eyes._window
    troubles = here.listen("lumen.trouble")
    assert here.told == [f"see their picture at {eyes._window.address}"]
    page = looking(eyes._window.address)
    until(lambda: eyes._window._lookers)  # type: ignore[union-attr]
    here.bus.publish("avatar.NAO.data.joint", {"name": ["HeadYaw", "HeadPitch"], "angle": [0.1, 0.0], "stiffness": []})
    here.settle()
    here.bus.publish("avatar.NAO.data.image", body(photographed, 1.0))
    seen = picture(page).astype(int)
    assert ((seen[:, :, 1] - seen[:, :, 0]) > 60).sum() > 100, "there is a frame around the face"
    assert eyes._head == "head +5.7 +0.0 deg"
    assert troubles.bodies == [], "its address is no business of others"
    page.close()
