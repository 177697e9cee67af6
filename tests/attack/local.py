"""Attacks from the machine on which an exhibition runs: frames to its local bus, files in its project."""

import socket
from random import Random

from lumen.bus.local import LocalAddress
from lumen.bus.local.frames import CLIENT, frame, nonce, proof, unframed
from lumen.errors import BusError
from lumen.project.home import ADDRESS_FILE, Home
from lumen.run.reload.requests import COMMAND
from tests.attack import files, messages
from tests.attack.attacks import Attack, Kind
from tests.attack.sound import sound
from tests.attack.targets import PATIENCE, BrokenError, Exhibition, save


class Local:
    """The lane that sends frames to the embedded bus, and saves hostile files.

    Each frame has its own connection; two of three prove that they know the key. Only one file at a time is
    hostile: the previous one is restored first. If the hostile file is accepted, the exhibition is checked on it.
    """

    kinds = (Kind.FRAME, Kind.FILE)
    batch = 250

    def __init__(self) -> None:
        self._keys, self._target, self._saved = list(sound()), Exhibition("memory://"), ""
        self._address = LocalAddress.of(Home(self._target.folder / ".lumen").read_json(ADDRESS_FILE) or {})
        self.size, self.close = self._target.size, self._target.close

    def strike(self, attack: Attack) -> str:
        return self._save(attack.random) if attack.kind is Kind.FILE else self._send(attack.random)

    def check(self) -> None:
        if self._saved:
            self._mend()
            self._reload()
        self._target.check()

    def _send(self, random: Random) -> str:
        known = random.random() < 2 / 3
        with self._connected() as wire:
            wire.settimeout(PATIENCE)
            try:
                if known:
                    self._prove(wire)
                wire.sendall(messages.frame(random, self._keys))
                wire.shutdown(socket.SHUT_WR)
                while wire.recv(1 << 16):
                    pass
            except TimeoutError:
                raise BrokenError("the door neither answers nor closes") from None
            except OSError:
                return "frames, hung up on"
        return "frames with the key" if known else "frames without"

    def _connected(self) -> socket.socket:
        try:
            return self._address.connect()
        except OSError as error:
            self._target.lives()
            raise BrokenError(f"the door does not open: {error}") from None

    def _prove(self, wire: socket.socket) -> None:
        buffer = bytearray()
        while not (words := next(unframed(buffer), None)):
            buffer += wire.recv(1 << 16)
        wire.sendall(frame("proof", proof(self._address.key, CLIENT, str(words[1])), nonce()))

    def _save(self, random: Random) -> str:
        path, content = files.project_file(random, self._target.sound)
        self._mend()
        save(self._target.folder / path, content)
        self._saved = path
        verdict = self._reload()
        if verdict == "applied":
            self._target.check()
        return f"files {verdict}"

    def _mend(self) -> None:
        if self._saved:
            save(self._target.folder / self._saved, self._target.sound[self._saved])
            self._saved = ""

    def _reload(self) -> str:
        try:
            answer = self._target.asked(COMMAND, {"command": "reload", "now": True})
        except BusError as error:
            raise BrokenError(f"nobody says what became of a file: {error}") from None
        return str(answer.get("verdict")) if isinstance(answer, dict) else str(answer)
