"""Which gesture goes with which phrase of a text.

A text has a tag where one of the tag's phrases is in it, as whole words. The gesture's stroke falls on the phrase; it
is prepared before (McNeill's phases of gesture). A long part of a text without any tag gets a beat.
"""

import re
from collections.abc import Collection, Iterator, Sequence
from functools import lru_cache
from itertools import pairwise
from typing import NamedTuple

from lumen.language.gestures import Gesture, GestureLibrary, WordTime
from lumen.motion.gestures.posing import BEAT
from lumen.motion.life.movements import chance

LONG_PART = 18
"""Characters from which on a part of a text without a tag gets a beat."""

TAIL = 0.4
"""How long after the last word a gesture may end [s]."""

_PART = re.compile(r"[^.,;:!?…]+[.,;:!?…]*\s*")


class PlannedGesture(NamedTuple):
    """A gesture that begins at `at` [s from the text's first word], with the other side where that is said."""

    gesture: Gesture
    at: float
    other_side: bool = False


class _Mention(NamedTuple):
    """A tag, and with which character of the text it is said."""

    tag: str
    where: float


def plan_gestures(
    text: str,
    language: str,
    library: GestureLibrary,
    duration: float,
    recent: Collection[str],
    seed: int,
    words: Sequence[WordTime] = (),
) -> tuple[PlannedGesture, ...]:
    """The gestures of a text that takes `duration` [s] to say, one after another, on the `words` where they are known.

    None of those whose names are `recent` is among them, nor any twice; the seed draws among those that fit.
    """
    planned: list[PlannedGesture] = []
    used, free_from = set(recent), 0.0
    for i, mention in enumerate(_mentions(text, language, library)):
        fitting = [g for g in library.gestures if mention.tag in g.tags and g.name not in used]
        if not fitting and mention.tag != BEAT:
            fitting = [g for g in library.gestures if BEAT in g.tags and g.name not in used]
        if not fitting:
            continue
        gesture = fitting[int(chance(seed, "gesture", i) * len(fitting))]
        said = _said_at(mention.where, len(text), duration, words)
        at = max(free_from, said - gesture.stroke)
        late = at + gesture.stroke - said
        if at + gesture.duration > duration + TAIL or late > gesture.stroke + gesture.duration / 2:
            continue
        planned.append(PlannedGesture(gesture, at, gesture.mirrored and chance(seed, "side", i) < 0.5))
        used.add(gesture.name)
        free_from = at + gesture.duration
    return tuple(planned)


def _mentions(text: str, language: str, library: GestureLibrary) -> Iterator[_Mention]:
    """The first tag of each part of the text, else a beat where the part is long."""
    for part in _PART.finditer(text):
        found = [
            (match.start(), tag)
            for tag, table in library.phrases.items()
            for phrase in (*table.get(language, ()), *table.get("any", ()))
            if (match := _words(phrase).search(part[0]))
        ]
        if found:
            start, tag = min(found)
            yield _Mention(tag, part.start() + start)
        elif len(part[0]) >= LONG_PART:
            yield _Mention(BEAT, part.start() + len(part[0]) / 2)


def _said_at(character: float, length: int, duration: float, words: Sequence[WordTime]) -> float:
    """When that character of so many is said [s]: evenly between the beginnings of two words, else of the whole."""
    known = (WordTime(0, 0.0), *words, WordTime(length, duration))
    for before, after in pairwise(known):
        if before.character <= character < after.character:
            part = (character - before.character) / (after.character - before.character)
            return before.at + part * (after.at - before.at)
    return duration


@lru_cache(maxsize=5_000)
def _words(phrase: str) -> re.Pattern[str]:
    """The phrase as whole words, however much space lies between them; `#` is any number."""
    words = (r"\d+" if word == "#" else re.escape(word) for word in phrase.split())
    return re.compile(r"(?<!\w)" + r"\s+".join(words) + r"(?!\w)", re.IGNORECASE)
