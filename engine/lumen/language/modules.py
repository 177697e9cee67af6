"""The modules besides robot, brain and motion: their names, and their settings in `lumen.yaml`."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from lumen.feature import table

MEMORY, EYES, EARS, VOICE, SOCIAL, SHOW, ANSWERS = "memory", "eyes", "ears", "voice", "social", "show", "answers"
"""The modules that Lumen's own code refers to; `module_names` has all of them."""

VISITOR_KEY = "visitor"
"""The key of a behaviour's context that holds the visitor's name, unless the memory's options name another."""


@dataclass(frozen=True, slots=True)
class ModuleSettings:
    """The settings of a module in lumen.yaml; one with a `command` is a program of the project's own."""

    here: bool = False
    """True if `lumen run` runs the module in its own process, or starts the module's program."""
    options: Mapping[str, Any] = field(default_factory=dict)
    """The module's own options."""
    command: tuple[str, ...] = ()
    """The command that starts the program; empty for a module of Lumen or of a feature."""
    health: float = 0.0
    """The longest time between two of the program's signs of life [s]; 0 if it gives none."""

    @property
    def own(self) -> bool:
        """True if the module is a program of the project's own."""
        return bool(self.command)


def own_modules(modules: Mapping[str, ModuleSettings]) -> dict[str, ModuleSettings]:
    """Return the modules that are programs of the project's own."""
    return {name: module for name, module in modules.items() if module.own}


def own_module_events(modules: Mapping[str, ModuleSettings]) -> dict[str, Mapping[str, object]]:
    """Return the events of the project's own modules, each with the JSON Schema of its data."""
    number, text = {"type": "number"}, {"type": "string"}
    lost = {"type": "object", "properties": {"seconds": number, "reason": text}, "required": ["seconds", "reason"]}
    found = {"type": "object", "properties": {"seconds": number}, "required": ["seconds"]}
    return {
        f"{name}.{what}": schema for name in own_modules(modules) for what, schema in (("lost", lost), ("found", found))
    }


def module_names() -> tuple[str, ...]:
    """Return the names of all modules, those of Lumen before those of other installed packages."""
    return tuple(table("modules"))
