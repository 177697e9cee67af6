"""Let a package offer names of other modules, each imported when it is first used."""

import sys
from collections.abc import Callable, Mapping, Sequence
from importlib import import_module
from typing import Any


def lazy(package: str, homes: Mapping[str, Sequence[str]]) -> Callable[[str], Any]:
    """Return the `__getattr__` of a package; `homes` are the names that it offers, by the module that defines them.

    The function raises AttributeError for any other name.
    """

    def imported(name: str) -> Any:
        for home, names in homes.items():
            if name in names:
                found = getattr(import_module(home), name)
                setattr(sys.modules[package], name, found)
                return found
        raise AttributeError(f"module `{package}` has no `{name}`")

    return imported
