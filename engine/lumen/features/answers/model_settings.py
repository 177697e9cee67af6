"""The module's settings in lumen.yaml: servers of models, and limits."""

import os
from collections.abc import Mapping
from typing import Any, NamedTuple

from lumen.errors import ModuleError


class ServerSettings(NamedTuple):
    """A model on a server."""

    url: str
    """The URL for requests."""
    name: str
    """The model's name on the server."""
    key: str = ""
    """The environment variable with the key; empty if the server needs no key."""

    @classmethod
    def of(cls, said: Mapping[str, Any]) -> "ServerSettings":
        """Return the settings in `{url: …, name: …, key: …}`."""
        return cls(said["url"], said["name"], said.get("key", ""))

    def secret(self) -> str:
        """Return the key from the environment, empty if the settings name no variable.

        Raises ModuleError if the variable is unset or empty, or is not printable ASCII.
        """
        if not self.key:
            return ""
        if not (found := os.environ.get(self.key, "").strip()) or not found.isascii() or not found.isprintable():
            raise ModuleError(f"the environment variable {self.key} has no key for the language model")
        return found


class ModelSettings(NamedTuple):
    """The language model and its limits."""

    server: ServerSettings | None
    """The model's server; None if only embeddings are used."""
    hour: int = 60
    """The maximum number of questions per hour."""
    visitor: int = 10
    """The maximum number of questions per visit."""

    @classmethod
    def of(cls, options: Mapping[str, Any]) -> "ModelSettings":
        """Return the settings in the module's options. Raises ModuleError if they lack both a model and embeddings."""
        model, budget = options.get("model"), options.get("budget") or {}
        if not isinstance(model, Mapping) and not isinstance(options.get("embeddings"), Mapping):
            raise ModuleError(
                "no language model is configured: write `model: {url: …, name: …}`, or `embeddings`, under `answers`"
            )
        server = ServerSettings.of(model) if isinstance(model, Mapping) else None
        return cls(server, budget.get("hour", 60), budget.get("visitor", 10))
