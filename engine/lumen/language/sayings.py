"""Sayings as tests: the sentences of visitors in a state, and the row of `hears` that should match each."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from lumen.language.diagnostics import NodePath


@dataclass(frozen=True)
class Saying:
    """A sentence of a visitor in a `state` (its id or path), and the key of the row of `hears` that should match it.

    `slots` are the values that the row should catch; other slots may catch anything.
    """

    behavior: str
    state: str
    row: str
    language: str
    text: str
    slots: Mapping[str, Any] = field(default_factory=dict)
    where: NodePath = field(default=(), compare=False)


@dataclass(frozen=True)
class SayingSet:
    """The sayings of `behaviors/sayings/NAME.yaml`, in the order of the file."""

    name: str
    sayings: tuple[Saying, ...]
