"""Sayings as tests: the sentences of visitors in a state, and the row of `hears` that should match each."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from lumen.language.diagnostics import NodePath


@dataclass(frozen=True)
class Saying:
    """A sentence of a visitor, and the row of `hears` that should match it."""

    behavior: str
    """The name of the behaviour."""
    state: str
    """The id or path of the active state."""
    row: str
    """The key of the row."""
    language: str
    text: str
    slots: Mapping[str, Any] = field(default_factory=dict)
    """The values that the row should catch; other slots may catch anything."""
    where: NodePath = field(default=(), compare=False)


@dataclass(frozen=True)
class SayingSet:
    """The sayings of `behaviors/sayings/NAME.yaml`, in the order of the file."""

    name: str
    sayings: tuple[Saying, ...]
