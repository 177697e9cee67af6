"""A words file as values: texts that the staff can edit without reading statecharts."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from lumen.language.machines import Answer


@dataclass(frozen=True)
class Words:
    """The content of `behaviors/words/NAME.yaml`, for every behaviour that names it under `words`."""

    name: str
    phrases: Mapping[str, Mapping[str, tuple[str, ...]]] = field(default_factory=dict)
    answers: Mapping[str, tuple[Answer, ...]] = field(default_factory=dict)
    lists: Mapping[str, tuple[Mapping[str, Any], ...]] = field(default_factory=dict)
    anyhow: frozenset[str] = frozenset()
