"""Manifests of features: names, data and import strings of all that a feature adds to Lumen.

A manifest imports nothing but this module, so reading all of them costs milliseconds. The object that a row
names is imported at its first use.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from importlib import import_module
from typing import Any

API = 1
"""The version of the rows below; a manifest of another version is refused."""

BUILT_IN = ("lumen.features.core:FEATURE",)
"""The manifests that come with Lumen, in the order in which their rows take part."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Feature:
    """One capability: its rows by kind. A text such as `package.module:name` is an import string.

    `extras` are those of the distribution that install what the feature needs.
    """

    name: str
    api: int = API
    extras: tuple[str, ...] = ()


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
