"""A language client over standard input and output, JSON-RPC by hand: the server as an editor sees it."""

import json
import sys
import threading
from pathlib import Path
from queue import Queue
from typing import Any, Self

from tests import ROOT
from tests.guarded import PIPE, Guarded
from tests.waiting import HANG

ENGINE = ROOT / "engine"


class Client:
    """A client of `lumen lsp` in a project; it keeps notifications until the test requests them."""

    def __init__(
        self, root: Path, command: list[str] | None = None, encoding: str = "utf-16", path: str = str(ENGINE)
    ) -> None:
        self.root = root
        self.process = Guarded(
            command or [sys.executable, "-m", "lumen", "lsp", "--stdio"],
            stdin=PIPE,
            stdout=PIPE,
            stderr=PIPE,
            env={"PYTHONPATH": path, "PATH": "/usr/bin:/bin:/usr/local/bin"},
            cwd=root,
        )
        self._messages: Queue[dict[str, Any] | None] = Queue()
        self._kept: list[dict[str, Any]] = []
        self._number = 0
        self._unwanted: set[int] = set()
        threading.Thread(target=self._read, daemon=True).start()
        self.capabilities = self.request(
            "initialize",
            processId=None,
            rootUri=root.as_uri(),
            capabilities={"general": {"positionEncodings": [encoding]}},
            workspaceFolders=[{"uri": root.as_uri(), "name": "project"}],
        )["capabilities"]
        self.notify("initialized")

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        if self.process.poll() is None:
            self.request("shutdown")
            self.notify("exit")
        self.process.wait(HANG)

    def uri(self, file: str) -> str:
        return (self.root / file).as_uri()

    def open(self, file: str, text: str | None = None, language: str = "yaml") -> str:
        text = (self.root / file).read_text("utf-8") if text is None else text
        document = {"uri": self.uri(file), "languageId": language, "version": 1, "text": text}
        self.notify("textDocument/didOpen", textDocument=document)
        return text

    def change(self, file: str, text: str, version: int = 2) -> None:
        document = {"uri": self.uri(file), "version": version}
        self.notify("textDocument/didChange", textDocument=document, contentChanges=[{"text": text}])

    def ask(self, method: str, file: str, line: int, character: int, **more: Any) -> Any:
        """Send a request about a line and a character, both from 0, and return its result."""
        position = {"line": line, "character": character}
        return self.request(f"textDocument/{method}", textDocument={"uri": self.uri(file)}, position=position, **more)

    def diagnostics(self, file: str) -> list[dict[str, Any]]:
        """Wait for the next findings that are published for a file, and return them."""
        while True:
            params = self._take(lambda m: m.get("method") == "textDocument/publishDiagnostics")["params"]
            if params["uri"] == self.uri(file):
                return list(params["diagnostics"])

    def message(self) -> str:
        """Wait for the next message to show to the user, and return its text."""
        return str(self.notified("window/showMessage")["message"])

    def notified(self, method: str) -> dict[str, Any]:
        """Wait for the next notification of a method, and return its parameters."""
        return dict(self._take(lambda m: m.get("method") == method)["params"])

    def request(self, method: str, **params: Any) -> Any:
        """Send a request and return its result; an error is a map with `code` and `message`."""
        self._number += 1
        number = self._number
        self._send({"id": number, "method": method, "params": params})
        answer = self._take(lambda m: m.get("id") == number and "method" not in m)
        return answer.get("result") if "error" not in answer else answer["error"]

    def ask_later(self, method: str, **params: Any) -> None:
        """Send a request, and ignore its answer when it comes."""
        self._number += 1
        self._unwanted.add(self._number)
        self._send({"id": self._number, "method": method, "params": params})

    def notify(self, method: str, **params: Any) -> None:
        self._send({"method": method, "params": params})

    def _send(self, message: dict[str, Any]) -> None:
        body = json.dumps({"jsonrpc": "2.0", **message}).encode()
        assert self.process.stdin
        self.process.stdin.write(b"Content-Length: %d\r\n\r\n%s" % (len(body), body))
        self.process.stdin.flush()

    def _take(self, wanted: Any) -> dict[str, Any]:
        for i, message in enumerate(self._kept):
            if wanted(message):
                return self._kept.pop(i)
        while True:
            message = self._messages.get(timeout=HANG)
            assert message is not None, "the server has ended"
            if "method" in message and "id" in message:  # the server asks: everything is as it is by default
                items = message["params"].get("items", []) if isinstance(message.get("params"), dict) else []
                self._send({"id": message["id"], "result": [None for _ in items] or None})
            elif wanted(message):
                return message
            elif message.get("id") not in self._unwanted:
                self._kept.append(message)

    def _read(self) -> None:
        assert self.process.stdout
        while header := self.process.stdout.readline():
            length = int(header.split(b":")[1])
            while self.process.stdout.readline().strip():
                pass
            self._messages.put(json.loads(self.process.stdout.read(length)))
        self._messages.put(None)
