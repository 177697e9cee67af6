"""What RabbitMQ's own tool says of a broker; nothing on it is changed."""

import json
import shlex
import subprocess
from typing import Any

from lumen.errors import BusError

USUAL = "rabbitmqctl"
TIMEOUT = 60.0
"""How long one command may take [s]."""


class RabbitMQControl:
    """`command` is how rabbitmqctl is called for that broker, as in `sudo rabbitmqctl` or `ssh HOST sudo rabbitmqctl`.

    Each method raises BusError, saying why, where the tool does not answer.
    """

    def __init__(self, command: str = USUAL) -> None:
        self.command = command

    def definitions(self) -> dict[str, list[dict[str, Any]]]:
        """Users, rights, exchanges, queues, bindings, parameters and policies, as `export_definitions` has them."""
        found = self._asked("export_definitions", "-")
        return found if isinstance(found, dict) else {}

    def shovels(self) -> list[dict[str, Any]]:
        """The shovels that there are, each with its `name` and `state`."""
        return self._rows("shovel_status")

    def federation(self) -> list[dict[str, Any]]:
        """The federation's links, each with its `id`, `exchange`, `status` and perhaps `error`."""
        return self._rows("federation_status")

    def _rows(self, *words: str) -> list[dict[str, Any]]:
        found = self._asked(*words, "--formatter", "json")
        return [row for row in found if isinstance(row, dict)] if isinstance(found, list) else []

    def _asked(self, *words: str) -> Any:
        try:
            command = [*shlex.split(self.command), "--quiet", *words]
            done = subprocess.run(
                command, stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace", timeout=TIMEOUT
            )
        except subprocess.TimeoutExpired:
            raise BusError(f"`{self.command}` did not end within {TIMEOUT:g} s") from None
        except (OSError, ValueError) as error:
            raise BusError(f"`{self.command}` can't be run: {error}") from None
        if done.returncode:
            said = (done.stderr or done.stdout).strip().splitlines() or [f"exit code {done.returncode}"]
            raise BusError(f"`{self.command} {words[0]}` failed: {said[0][:200]}")
        try:
            return json.loads(done.stdout)
        except ValueError:
            raise BusError(f"`{self.command} {words[0]}` did not print JSON") from None
