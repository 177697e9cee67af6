"""The settings of features, from the sections of lumen.yaml."""

from collections.abc import Mapping
from typing import TypeVar

T = TypeVar("T")

Sections = Mapping[str, object]
"""The settings of features by their keys in lumen.yaml, without sections that equal their defaults."""


def section_of(sections: Sections, kind: type[T]) -> T:
    """Return the settings of this type, the type's defaults if there are none."""
    for settings in sections.values():
        if isinstance(settings, kind):
            return settings
    return kind()
