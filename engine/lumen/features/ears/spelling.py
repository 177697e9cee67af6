"""Words that no English dictionary has, as they are spelt in Indonesian: names, and what visitors say in it."""

import re

_SOUNDS = {
    "ngg": "NG G", "ng": "NG", "ny": "N Y", "sy": "SH", "kh": "K", "ai": "AY", "au": "AW",
    "a": "AA", "b": "B", "c": "CH", "d": "D", "e": "AH", "f": "F", "g": "G", "h": "HH", "i": "IY", "j": "JH", "k": "K",
    "l": "L", "m": "M", "n": "N", "o": "OW", "p": "P", "q": "K", "r": "R", "s": "S", "t": "T", "u": "UW", "v": "F",
    "w": "W", "x": "K S", "y": "Y", "z": "Z",
}  # fmt: skip
"""Indonesian is written as it is spoken; these are the nearest of the 39 sounds of CMU's dictionary."""

_LETTERS = re.compile("|".join(sorted(_SOUNDS, key=len, reverse=True)))


def pronounced(word: str) -> str:
    """The sounds of a word in small letters, as PocketSphinx names them; empty where it has no letters."""
    return " ".join(_SOUNDS[letters] for letters in _LETTERS.findall(word))
