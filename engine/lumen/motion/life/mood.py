"""Which style the active states ask for."""

from collections.abc import Collection

from lumen.language.life import STILL
from lumen.language.machines import MachineDefinition


def style_name(machine: MachineDefinition, configuration: Collection[str]) -> str:
    """The name of the style that the active states say with `life`, `still` where none does.

    What a state says holds for the states within it, until one of these says something else. Of states side by side
    `still` goes before everything; else the first one in the file decides.
    """
    active = [path for path, state in machine.states.items() if not path or state.name in configuration]
    saying = [path for path in active if machine.states[path].life]
    inner = [path for path in saying if not any(_within(other, path) for other in saying)]
    styles = [machine.states[path].life for path in inner]
    return STILL if STILL in styles or not styles else styles[0]


def gestures_wanted(machine: MachineDefinition, configuration: Collection[str]) -> bool:
    """Whether no active state says `gestures: none`."""
    return not any(state.gestures for path, state in machine.states.items() if not path or state.name in configuration)


def _within(path: str, outer: str) -> bool:
    return path != outer and (not outer or path.startswith(f"{outer}."))
