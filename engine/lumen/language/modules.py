"""The modules beside robot, brain and motion: what an exhibition may have, and what `lumen.yaml` says of each."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from lumen.feature import table

MEMORY, EYES, EARS, VOICE, SOCIAL, SHOW, ANSWERS = "memory", "eyes", "ears", "voice", "social", "show", "answers"
"""The modules that Lumen's own code refers to; `module_names` has all of them."""

VISITOR_KEY = "visitor"
"""The key of a behaviour's context that holds the visitor's name, where the memory's options do not say another."""


@dataclass(frozen=True, slots=True)
class ModuleSettings:
    """What `lumen.yaml` says of a module: whether `lumen run` has it inside (`here`), and its own options."""

    here: bool = False
    options: Mapping[str, Any] = field(default_factory=dict)


def module_names() -> tuple[str, ...]:
    """Return the names of all modules, those of Lumen first."""
    return tuple(table("modules"))
