"""What a words file says: texts that staff edit without seeing states."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from lumen.language.machines import Answer


@dataclass(frozen=True)
class Words:
    """The phrases and answers of `behaviors/words/NAME.yaml`, for every behaviour that names it under `words`."""

    name: str
    phrases: Mapping[str, Mapping[str, tuple[str, ...]]] = field(default_factory=dict)
    answers: Mapping[str, tuple[Answer, ...]] = field(default_factory=dict)
