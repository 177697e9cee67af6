"""An exhibition and its console in processes of their own, and the faults that may happen to them."""

import os
import signal
import sys
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from typing import Any

from lumen.errors import BusError
from lumen.run.asking import OPERATOR_ANSWERS, operator_key, send_request
from lumen.run.reaching import Reached, reach_exhibition
from tests.features.console.pages import Browser
from tests.guarded import DEVNULL, STDOUT, Guarded
from tests.rabbitmq import RabbitMQ, _free_ports
from tests.relay import Relay
from tests.waiting import HANG, until

WHOLE, ROBOT, REST_OF_IT, CONSOLE = "whole", "robot", "remote", "console"
ANSWER = 3.0
"""Seconds to wait for an answer before the question is sent again."""


class House:
    """An exhibition of the project in `folder`, a recording robot, and a console; `start` returns when all are there.

    With a broker robot and brain are processes of their own, and the console reaches it over `wire`; without one all is
    one process. A browser reaches the console at `address`, over `network`. Both can be cut.
    """

    def __init__(self, folder: Path, broker: RabbitMQ | None = None) -> None:
        self.folder, self.broker = folder, broker
        self.wire = Relay(broker.port) if broker else None
        (self.port,) = _free_ports(1)
        self.network = Relay(self.port)
        self.address = f"http://127.0.0.1:{self.network.port}/"
        self.browser = Browser(f"http://127.0.0.1:{self.port}/")
        self.processes: dict[str, Guarded[bytes]] = {}
        self.told = folder / "told.txt"
        self._held: Reached | None = None

    @property
    def parts(self) -> tuple[str, ...]:
        return (ROBOT, REST_OF_IT) if self.broker else (WHOLE,)

    def start(self) -> None:
        for name in (*self.parts, CONSOLE):
            self.begin(name)
        self.await_page()

    def begin(self, name: str) -> None:
        """Start one of the processes."""
        lumen = [sys.executable, "-m", "lumen"]
        if name == CONSOLE:
            wire = ["--bus", self._url(self.wire.port)] if self.wire else []
            line = [*lumen, "console", self.folder, "--port", self.port, *wire]
        else:
            bus = ["--bus", self.broker.url] if self.broker else []
            part = {ROBOT: ["--only", ROBOT, "--robot", "recording"], REST_OF_IT: ["--robot", "remote"]}
            whole = ["--robot", "recording"]
            line = [*lumen, "run", self.folder, *part.get(name, whole), "--speed", "1", *bus]
        with self.told.open("ab") as file:
            self.processes[name] = Guarded(line, stdin=DEVNULL, stdout=file, stderr=STDOUT)

    def kill(self, name: str) -> None:
        """End a process as a power cut would."""
        process = self.processes.pop(name)
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()

    def signal(self, name: str, number: int) -> None:
        """Send a process a signal: SIGSTOP lets it hang, and SIGCONT lets it continue."""
        os.killpg(self.processes[name].pid, number)

    def listens(self) -> bool:
        """Return whether the console answers at all."""
        with suppress(OSError, ValueError):
            return self.browser.get("/api/now").status == 200
        return False

    def await_page(self) -> None:
        """Wait until the console shows the state of the robot."""
        until(self._shown, HANG)

    def await_robot(self) -> None:
        """Wait until the robot answers, and the console shows it."""
        until(lambda: self.stopped_by() is not None, HANG)
        self.await_page()

    def stopped_by(self) -> str | None:
        """Return the source of the stop, as the robot reports it; empty without a stop, None without an answer."""
        answer = self.ask_robot("stopped")
        return answer["stopped_by"] if isinstance(answer, dict) else None

    def resume(self) -> None:
        """Let the robot move again, with a message to the robot itself, not through the console."""
        until(lambda: self.ask_robot("resume") == "command finished" and self.stopped_by() == "", HANG)

    def ask_robot(self, method: str, **parameter: Any) -> Any:
        """Ask the robot on its key `stop`, and return its answer; None if none comes."""
        return self._answer(lambda reached: reached.stop, {"type": "motion", "method": method, "parameter": parameter})

    def ask_brain(self, question: Mapping[str, Any]) -> Any:
        """Ask the exhibition as an operator, and return its answer; None if none comes."""
        return self._answer(lambda reached: operator_key(reached.robot), question)

    def insist_on(self, question: Mapping[str, Any]) -> dict[str, Any]:
        """Ask the exhibition again until it answers, and return its answer."""
        answers: list[Any] = []
        until(lambda: answers.append(self.ask_brain(question)) or answers[-1] is not None, HANG)
        return dict(answers[-1])

    def send(self, key: str, body: Any) -> None:
        """Send a message as another module would; one that can't be sent now is lost."""
        with suppress(BusError):
            self._reached().bus.publish(key, body)

    def close(self) -> None:
        self._let_go()
        for name in reversed(tuple(self.processes)):
            self.kill(name)
        self.network.close()
        if self.wire:
            self.wire.close()

    def _reached(self) -> Reached:
        """Return a bus of the test itself, which uses neither the console nor its wire."""
        if self._held is None:
            self._held = reach_exhibition(str(self.folder), self.broker.url if self.broker else None)
        return self._held

    def _answer(self, key: Callable[[Reached], str], body: Any) -> Any:
        try:
            reached = self._reached()
            return next(send_request(reached.bus, key(reached), body, OPERATOR_ANSWERS, first=ANSWER))
        except BusError:
            self._let_go()
            return None

    def _let_go(self) -> None:
        if self._held:
            self._held.bus.close()
        self._held = None

    def _shown(self) -> bool:
        dead = [name for name, process in self.processes.items() if process.poll() is not None]
        assert not dead, f"{dead} ended:\n{self.told.read_text(errors='replace')[-3000:]}"
        with suppress(OSError, ValueError):
            return any(robot["connected"] for robot in self.browser.robots)
        return False

    def _url(self, port: int) -> str:
        assert self.broker
        return self.broker.url.replace(f":{self.broker.port}", f":{port}")
