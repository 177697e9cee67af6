"""Gestures that accompany speech, from `motions/gestures/NAME.yaml`: frozen values."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from lumen.language.diagnostics import NodePath


class WordTime(NamedTuple):
    """A word of a text: its first `character`, counted from 0, is heard `at` [s] after the beginning of the text."""

    character: int
    at: float


@dataclass(frozen=True, slots=True)
class Gesture:
    """A movement of arms and head during a phrase: preparation, stroke, hold and retraction."""

    name: str
    """The gesture's name in the file."""
    tags: tuple[str, ...]
    """The tags of the texts that the gesture accompanies."""
    tracks: Mapping[str, tuple[tuple[float, float], ...]]
    """For each joint, its keys (time [s], offset from its current angle [rad; hands 0..1]), from zero back to zero."""
    stroke: float
    """The time of the stroke [s]."""
    duration: float
    """The time at which the joints have returned [s]."""
    mirrored: bool = False
    """True if the gesture may also be performed on the other side, by `mirror`."""
    where: NodePath = field(default=(), compare=False)
    mirror: Mapping[str, tuple[str, float]] = field(default_factory=dict)
    """For each joint of the gesture, the opposite one and the factor of its angle, as in `language/mirrors.py`."""


@dataclass(frozen=True, slots=True)
class GestureLibrary:
    """Gestures, and the phrases that select them for a text."""

    gestures: tuple[Gesture, ...] = ()
    phrases: Mapping[str, Mapping[str, tuple[str, ...]]] = field(default_factory=dict)
    """The phrases by tag and language, `any` for all languages; a text that contains one gets its tag."""

    def __bool__(self) -> bool:
        return bool(self.gestures)


NO_GESTURES = GestureLibrary()


def merged(libraries: Mapping[str, GestureLibrary]) -> GestureLibrary:
    """Return all libraries of a project as one, with the phrases of each tag combined."""
    phrases: dict[str, dict[str, tuple[str, ...]]] = {}
    for library in libraries.values():
        for tag, table in library.phrases.items():
            known = phrases.setdefault(tag, {})
            for language, rows in table.items():
                known[language] = (*known.get(language, ()), *rows)
    return GestureLibrary(tuple(g for library in libraries.values() for g in library.gestures), phrases)
