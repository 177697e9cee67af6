"""The page with examples of the console's components, and a server for it: the console itself has no such page."""

import threading
from functools import partial
from http.server import SimpleHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Self

from tests import ROOT

FOLDERS = {"pages": ROOT / "engine/lumen/features/console/pages", "examples": Path(__file__).parent}


class Examples:
    """Serves the pages' files and the examples on a thread, until it is closed."""

    def __init__(self, port: int = 0) -> None:
        self._server = ThreadingHTTPServer(("127.0.0.1", port), partial(_Handler, directory=str(ROOT)))
        self.address = f"http://127.0.0.1:{self._server.server_port}/"
        self._thread = threading.Thread(target=self._server.serve_forever)
        self._thread.start()

    def close(self) -> None:
        self._server.shutdown()
        self._thread.join()
        self._server.server_close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


class _Handler(SimpleHTTPRequestHandler):
    def translate_path(self, path: str) -> str:
        first, _, rest = path.partition("?")[0].lstrip("/").partition("/")
        folder = FOLDERS.get(first)
        return str(folder / rest) if folder and ".." not in rest else str(ROOT / "nothing")

    def log_message(self, format: str, *args: object) -> None:
        pass
