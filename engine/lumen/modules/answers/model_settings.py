"""What lumen.yaml says of the language model."""

import os
from collections.abc import Mapping
from typing import Any, NamedTuple

from lumen.errors import ModuleError


class ModelSettings(NamedTuple):
    """Where it is, what it is called there, and the environment variable that holds its key, empty for none."""

    url: str
    name: str
    key: str = ""
    hour: int = 60
    visitor: int = 10

    @classmethod
    def of(cls, options: Mapping[str, Any]) -> "ModelSettings":
        """The settings of the module's options. Raises ModuleError where the model's are left out."""
        model, budget = options.get("model"), options.get("budget") or {}
        if not isinstance(model, Mapping):
            raise ModuleError("no language model is configured: write `model: {url: …, name: …}` under `answers`")
        return cls(model["url"], model["name"], model.get("key", ""), budget.get("hour", 60), budget.get("visitor", 10))

    def secret(self) -> str:
        """The key, from the environment. Raises ModuleError where it is not set."""
        if not self.key:
            return ""
        if not (found := os.environ.get(self.key, "").strip()) or not found.isascii() or not found.isprintable():
            raise ModuleError(f"the environment variable {self.key} holds no key for the language model")
        return found
