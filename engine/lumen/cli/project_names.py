"""The names of the project around us, for who completes a command line: as many as can be had in a moment."""

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path

import lumen
from lumen.errors import LumenError
from lumen.project.building import main_settings
from lumen.project.files import composed
from lumen.project.running_project import running_project


def names_of(placeholder: str) -> Sequence[str]:
    """Return what the project that a command would show has for the placeholder of an argument; none if unknown."""
    found = PLACEHOLDERS.get(placeholder)
    return sorted(found(running_project())) if found else ()


def _files(folder: str) -> Callable[[Path], Iterable[str]]:
    return lambda root: [composed(file.stem) for file in (root / folder).glob("*.yaml")]


def _codes(root: Path) -> Iterable[str]:
    from lumen.lint.codes import codes, families  # with all rules: only for who asks for codes

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
"""By the word that stands for an argument in `--help`, else by what it is called; others are files, or typed freely."""
