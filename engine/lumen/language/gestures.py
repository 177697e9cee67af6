"""Gestures that accompany speech, as `motions/gestures/NAME.yaml` says them: frozen values."""

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
    """Arms and head beside a phrase: prepared, the stroke at `stroke` [s], held, and taken back at `duration` [s].

    `tags` are what it goes with. `tracks` has for each joint where it is at which time [s]: offsets from where it
    stands [rad; hands 0..1], from nothing and back to nothing. It may also be done with the other side where
    it is `mirrored`, as `mirror` says for its joints (`language/mirrors.py`).
    """

    name: str
    tags: tuple[str, ...]
    tracks: Mapping[str, tuple[tuple[float, float], ...]]
    stroke: float
    duration: float
    mirrored: bool = False
    where: NodePath = field(default=(), compare=False)
    mirror: Mapping[str, tuple[str, float]] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class GestureLibrary:
    """Gestures, and by which phrases in which language (`any` for each) a text has their tags."""

    gestures: tuple[Gesture, ...] = ()
    phrases: Mapping[str, Mapping[str, tuple[str, ...]]] = field(default_factory=dict)

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
