"""A live view of the eyes' images and findings, in a browser on this machine."""

import threading
from typing import TYPE_CHECKING

from lumen.errors import ModuleError
from lumen.features.eyes.detector import Box
from lumen.features.eyes.opencv import opencv
from lumen.features.eyes.window_server import WindowServer
from lumen.upkeep.threads import WatchedThread

if TYPE_CHECKING:
    from lumen.features.eyes.pictures import Grey
    from lumen.features.eyes.window_server import WindowPage

PART_BOUNDARY = "frame"
FACE_COLOUR, PERSON_COLOUR, TEXT_COLOUR = (0, 200, 0), (200, 120, 0), (255, 255, 255)
"""Colours as (blue, green, red), from 0 to 255."""
WAKE_INTERVAL = 1.0
"""The time between two checks for a closed window or browser while no new picture arrives [s]."""


class Window:
    """Serves a stream of JPEGs at `address`; pictures are made only while a browser is connected.

    Port 0 means any free port. Raises ModuleError if the port can't be used.
    """

    def __init__(self, port: int) -> None:
        self._cv2 = opencv()
        self._changed = threading.Condition()
        self._picture, self._number, self._lookers, self._open = b"", 0, 0, True
        try:
            self._server = WindowServer(port, self.serve)
        except (OSError, OverflowError) as error:
            raise ModuleError(f"the eyes' window cannot be opened on port {port}: {error}") from None
        self.address = self._server.address
        self._thread = WatchedThread("lumen-window", self._server.serve_forever)
        self._thread.start()

    def show(self, grey: "Grey", faces: list[Box], people: list[Box], words: str) -> None:
        """Show the picture with a box around each face and person, and a line of text; do nothing without a browser."""
        if not self._lookers:
            return
        cv2 = self._cv2
        picture = cv2.cvtColor(grey, cv2.COLOR_GRAY2BGR)
        for boxes, colour in ((people, PERSON_COLOUR), (faces, FACE_COLOUR)):
            for x, y, width, height in boxes:
                cv2.rectangle(picture, (round(x), round(y)), (round(x + width), round(y + height)), colour, 2)
        cv2.putText(
            picture, words, (6, picture.shape[0] - 8), cv2.FONT_HERSHEY_SIMPLEX, 0.4, TEXT_COLOUR, 1, cv2.LINE_AA
        )
        data = cv2.imencode(".jpg", picture)[1].tobytes()
        with self._changed:
            self._picture, self._number = data, self._number + 1
            self._changed.notify_all()

    def serve(self, page: "WindowPage") -> None:
        """Send new pictures until the browser disconnects or the window is closed."""
        page.send_response(200)
        page.send_header("Content-Type", f"multipart/x-mixed-replace; boundary={PART_BOUNDARY}")
        page.send_header("Cache-Control", "no-store")
        page.send_header("Cross-Origin-Resource-Policy", "same-origin")
        page.end_headers()
        with self._changed:
            self._lookers, seen = self._lookers + 1, self._number
        try:
            while self._open and page.wanted():
                with self._changed:
                    if not self._changed.wait_for(lambda: self._number > seen or not self._open, WAKE_INTERVAL):  # noqa: B023
                        continue
                    seen, data = self._number, self._picture
                head = f"--{PART_BOUNDARY}\r\nContent-Type: image/jpeg\r\nContent-Length: {len(data)}\r\n\r\n"
                page.wfile.write(head.encode() + data + b"\r\n")
        except OSError:
            pass  # the browser disconnected or stopped reading
        finally:
            with self._changed:
                self._lookers -= 1

    def close(self) -> None:
        """Close the window; further calls do nothing."""
        with self._changed:
            self._open = False
            self._changed.notify_all()
        self._server.shutdown()
        self._server.server_close()
