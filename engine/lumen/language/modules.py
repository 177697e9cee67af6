"""The modules beside robot, brain and motion: what an exhibition may have, and what `lumen.yaml` says of each."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

MEMORY, EYES, EARS, VOICE, SOCIAL, SHOW, ANSWERS = MODULES = (
    "memory", "eyes", "ears", "voice", "social", "show", "answers",
)  # fmt: skip

VISITOR_KEY = "visitor"
"""The key of a behaviour's context that holds the visitor's name, where the memory's options do not say another."""


@dataclass(frozen=True, slots=True)
class ModuleSettings:
    """What `lumen.yaml` says of a module: whether `lumen run` has it inside (`here`), and its own options."""

    here: bool = False
    options: Mapping[str, Any] = field(default_factory=dict)
