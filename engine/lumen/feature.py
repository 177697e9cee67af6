"""Manifests of features: names, data and import strings of all that a feature adds to Lumen.

A manifest imports nothing but this module, so reading all of them costs milliseconds. The object that a row
names is imported at its first use.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from enum import IntEnum, auto
from functools import cache
from importlib import import_module
from typing import Any

API = 1
"""The version of the rows below; a manifest of another version is refused."""

BUILT_IN = ("lumen.features.core:FEATURE",)
"""The manifests that come with Lumen, in the order in which their rows take part."""


class Phase(IntEnum):
    """When a part of an exhibition is made, and ticked: those of a lower phase come first."""

    RECORD = auto()
    """Parts that hear everything that the others say."""
    BEHAVIOR = auto()
    """No parts yet: the behaviour, which the others serve or watch."""
    WORLD = auto()
    """The visitor and the robot."""
    WATCH = auto()
    """Observers of the behaviour's steps."""
    SERVE = auto()
    """Parts that act on the behaviour between two steps: saved files, operators, people to forget."""
    ALERT = auto()
    SHOW = auto()
    """The film and the console."""
    VISIT = auto()
    """A person who types."""
    MODULES = auto()
    BRAIN = auto()
    """The part that steps the behaviour."""
    KEEP = auto()
    """Parts that keep or show what the behaviour did."""


@dataclass(frozen=True, slots=True)
class PartRow:
    """A part of an exhibition: `make` is an import string of a function that takes the services made so far.

    It returns a part, several, or none. Rows of one phase come by name, or `after` another one. The conditions in
    `when` have to hold: `whole` (one process has everything), `brain` (the behaviour runs in this process), `follows`
    (it does not), `role:NAME` (this is that process of several), `option:NAME` (the plan has that option). A `claimed`
    part is made after the process has claimed the robot on the bus: it opens what another process may have open.
    """

    name: str
    phase: Phase
    make: str
    when: str = ""
    after: str = ""
    claimed: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Feature:
    """One capability: its rows by kind. A text such as `package.module:name` is an import string.

    `parts` take part in an exhibition.

    `extras` are those of the distribution that install what the feature needs.
    """

    name: str
    api: int = API
    extras: tuple[str, ...] = ()
    parts: tuple[PartRow, ...] = ()


def resolve(where: str) -> Any:
    """Return what an import string names: a module, or with `:NAME` an object of it.

    Raises ImportError if there is no such module, AttributeError if the module has no such object.
    """
    module, _, name = where.partition(":")
    found = import_module(module)
    return getattr(found, name) if name else found


@cache
def features() -> tuple[Feature, ...]:
    """Return the manifests of all features, those that come with Lumen first."""
    return tuple(resolve(where) for where in BUILT_IN)


def rows(kind: str) -> Iterator[tuple[Feature, Any]]:
    """Iterate over the rows of a kind, such as `extras`, each with its feature; a row of a mapping is a pair."""
    for feature in features():
        found = getattr(feature, kind)
        for row in found.items() if isinstance(found, Mapping) else found:
            yield feature, row
