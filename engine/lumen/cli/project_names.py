"""The names of the project around the working directory, for completion on a command line."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path

import lumen
from lumen.errors import LumenError
from lumen.project.files import composed
from lumen.project.main_file import main_settings
from lumen.project.running_project import running_project


def names_of(placeholder: str) -> Sequence[str]:
    """Return the names that the project has for the placeholder of an argument; empty for an unknown placeholder."""
    found = PLACEHOLDERS.get(placeholder)
    return sorted(found(running_project())) if found else ()


def _files(folder: str) -> Callable[[Path], Iterable[str]]:
    return lambda root: [composed(file.stem) for file in (root / folder).glob("*.yaml")]


def _codes(root: Path) -> Iterable[str]:
    from lumen.lint.codes import codes, families  # imports all rules, so only when codes are completed

    return [*codes(), *families()]


def _languages(root: Path) -> Iterable[str]:
    settings = main_settings(root)
    return settings.languages if settings else ()


def _routes(root: Path) -> Iterable[str]:
    settings = main_settings(root)
    return settings.routes if settings else ()


def _states(root: Path) -> Iterable[str]:
    try:
        project = lumen.load(root)
    except LumenError:
        return ()
    return {state.name for state in project.machine.states.values() if state.path}


PLACEHOLDERS: Mapping[str, Callable[[Path], Iterable[str]]] = {
    "STORY": _files("behaviors/stories"),
    "[PROJECT] STORY": lambda root: {*_files("behaviors/stories")(root), *_files("behaviors/sayings")(root)},
    "MOTION": _files("motions"),
    "BEHAVIOR": _files("behaviors"),
    "CODE": _codes,
    "CODES": _codes,
    "LANG": _languages,
    "STATE": _states,
    "WHAT": lambda root: {*_states(root), *_files("motions")(root)},
    "ROUTE": _routes,
    "OLD": lambda root: ("live", "HEAD"),
}
"""The functions that find names in a project's folder, by the placeholder of an argument in `--help`.

For an argument without a placeholder the key is its destination in capitals. All other arguments are files or free
text.
"""
