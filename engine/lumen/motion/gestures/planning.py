"""The choice of gestures for the phrases of a text.

A tag matches if one of its phrases occurs in the text as whole words. The stroke of the gesture coincides with the
phrase; its preparation comes before (McNeill's phases of gesture). A long part of the text without a tag gets a beat.
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
"""Minimum length of a part without a tag that gets a beat [characters]."""

TAIL = 0.4
"""Maximum time from the last word to the end of a gesture [s]."""

_PART = re.compile(r"[^.,;:!?…]+[.,;:!?…]*\s*")


class PlannedGesture(NamedTuple):
    """A gesture that begins `at` [s] after the text's first word, mirrored if `other_side` is set."""

    gesture: Gesture
    at: float
    other_side: bool = False


class _Mention(NamedTuple):
    """A tag and the position in the text of the phrase that matched [characters]."""

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
    """Return the gestures of a text that takes `duration` [s], in order, aligned with `words` if they are known.

    Gestures named in `recent` are excluded, and no gesture occurs twice; `seed` determines the choice among the rest.
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
    """Yield the first tag of each part of the text, or a beat if the part is long."""
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
    """Return when a character is spoken [s], interpolated between the known starts of words."""
    known = (WordTime(0, 0.0), *words, WordTime(length, duration))
    for before, after in pairwise(known):
        if before.character <= character < after.character:
            part = (character - before.character) / (after.character - before.character)
            return before.at + part * (after.at - before.at)
    return duration


@lru_cache(maxsize=5_000)
def _words(phrase: str) -> re.Pattern[str]:
    """Return a pattern of the phrase as whole words with any space between them; `#` matches any number."""
    words = (r"\d+" if word == "#" else re.escape(word) for word in phrase.split())
    return re.compile(r"(?<!\w)" + r"\s+".join(words) + r"(?!\w)", re.IGNORECASE)
