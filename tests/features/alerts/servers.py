"""Servers on loopback that receive alerts: one for webhooks, one for mail."""

import base64
import json
import socket
import ssl
import threading
from collections.abc import Callable
from contextlib import suppress
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any

from tests.waiting import HANG, until


class Web:
    """Keeps what is posted; answers with each of `statuses` once, then with 200. It refuses connections once closed."""

    def __init__(self, *statuses: int) -> None:
        self.statuses, self.bodies = list(statuses), list[dict[str, Any]]()
        self.heads: list[dict[str, str]] = []
        self.hold = threading.Event()
        self.hold.set()
        web = self

        class Handler(BaseHTTPRequestHandler):
            def do_POST(self) -> None:
                web.hold.wait(HANG)
                body = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
                status = web.statuses.pop(0) if web.statuses else 200
                web.heads.append(dict(self.headers))
                web.bodies.append(body)
                self.send_response(status)
                if status == 302:
                    self.send_header("Location", "http://127.0.0.1:1/")
                self.end_headers()

            def log_message(self, format: str, *arguments: Any) -> None:
                pass

        self._server = ThreadingHTTPServer(("127.0.0.1", 0), Handler)
        self._server.daemon_threads = True
        self.url = f"http://127.0.0.1:{self._server.server_address[1]}/hook"
        threading.Thread(target=self._server.serve_forever, args=(0.02,), daemon=True).start()

    def told(self, kind: str, count: int = 1) -> list[dict[str, Any]]:
        """Wait for `count` alerts of that kind, and return all of them."""
        until(lambda: len(self.of(kind)) >= count)
        return self.of(kind)

    def of(self, kind: str) -> list[dict[str, Any]]:
        return [body for body in self.bodies if body["kind"] == kind]

    def close(self) -> None:
        self.hold.set()
        self._server.shutdown()
        self._server.server_close()


class Post:
    """A mail server that keeps the mails and the logins it receives. `answers` replace its replies to commands."""

    def __init__(self, certificate: Path | None = None, **answers: str) -> None:
        self.mails: list[str] = []
        self.users: list[str] = []
        self._answers, self._context = answers, None
        if certificate:
            self._context = ssl.create_default_context(ssl.Purpose.CLIENT_AUTH)
            self._context.load_cert_chain(certificate / "server.pem", certificate / "server.key")
        self._listening = socket.create_server(("127.0.0.1", 0))
        self.port = self._listening.getsockname()[1]
        threading.Thread(target=self._accept, daemon=True).start()

    def close(self) -> None:
        with suppress(OSError):
            self._listening.shutdown(socket.SHUT_RDWR)  # ends the waiting of `_accept`
        self._listening.close()

    def _accept(self) -> None:
        with suppress(OSError):
            while True:
                wire, _ = self._listening.accept()
                threading.Thread(target=self._serve, args=(wire,), daemon=True).start()

    def _serve(self, wire: socket.socket) -> None:
        with suppress(OSError, ssl.SSLError):
            self._talk(wire)
        wire.close()

    def _talk(self, wire: socket.socket) -> None:
        file = wire.makefile("rwb")

        def say(line: str) -> None:
            file.write(line.encode() + b"\r\n")
            file.flush()

        say("220 post")
        secure = False
        while line := file.readline().decode().strip():
            verb = line.split()[0].upper()
            if verb in self._answers:
                say(self._answers[verb])
            elif verb == "EHLO":
                offers = ["STARTTLS"] if self._context and not secure else ["AUTH PLAIN"] if secure else []
                for offer in ["post", *offers]:
                    say(f"250-{offer}")
                say("250 ok")
            elif verb == "STARTTLS":
                assert self._context
                say("220 go")
                wire = self._context.wrap_socket(wire, server_side=True)
                file, secure = wire.makefile("rwb"), True
            elif verb == "AUTH":
                self.users.append(base64.b64decode(line.split()[2]).decode().replace("\0", "/"))
                say("235 ok")
            elif verb == "DATA":
                say("354 go")
                self.mails.append(_until_dot(file.readline))
                say("250 ok")
            elif verb == "QUIT":
                say("221 bye")
                return
            else:
                say("250 ok")


def _until_dot(readline: Callable[[], bytes]) -> str:
    lines = []
    while (line := readline()) not in (b".\r\n", b""):
        lines.append(line.decode())
    return "".join(lines)
