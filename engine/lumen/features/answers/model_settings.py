"""What lumen.yaml says of the servers that the module asks."""

import os
from collections.abc import Mapping
from typing import Any, NamedTuple

from lumen.errors import ModuleError


class ServerSettings(NamedTuple):
    """Where a model is, what it is called there, and the environment variable that holds its key, empty for none."""

    url: str
    name: str
    key: str = ""

    @classmethod
    def of(cls, said: Mapping[str, Any]) -> "ServerSettings":
        """The settings of `{url: …, name: …, key: …}`."""
        return cls(said["url"], said["name"], said.get("key", ""))

    def secret(self) -> str:
        """The key, from the environment. Raises ModuleError where it is not set."""
        if not self.key:
            return ""
        if not (found := os.environ.get(self.key, "").strip()) or not found.isascii() or not found.isprintable():
            raise ModuleError(f"the environment variable {self.key} has no key for the language model")
        return found


class ModelSettings(NamedTuple):
    """The language model, None where only embeddings are asked for; how many questions an hour, and by one visitor."""

    server: ServerSettings | None
    hour: int = 60
    visitor: int = 10

    @classmethod
    def of(cls, options: Mapping[str, Any]) -> "ModelSettings":
        """The settings of the module's options. Raises ModuleError where they name no server at all."""
        model, budget = options.get("model"), options.get("budget") or {}
        if not isinstance(model, Mapping) and not isinstance(options.get("embeddings"), Mapping):
            raise ModuleError(
                "no language model is configured: write `model: {url: …, name: …}`, or `embeddings`, under `answers`"
            )
        server = ServerSettings.of(model) if isinstance(model, Mapping) else None
        return cls(server, budget.get("hour", 60), budget.get("visitor", 10))
