"""Find characters that look like those of a keyboard but differ: foreign letters, dashes, invisible characters."""

import unicodedata
from collections.abc import Iterator

_TWINS = str.maketrans(
    "АВЕЅІЈКМНОРСТУХаеѕіјорсухԁһԛԝΑΒΕΖΗΙΚΜΝΟΡΤΥΧοαινρυıɑɡℓ‐‑‒–—−﹣",
    "ABESIJKMHOPCTYXaesijopcyxdhqwABEZHIKMNOPTYXoaivpuiagl-------",
)


def typed(text: str) -> str:
    """Return the text as typed on a keyboard: Latin letters, digits and minus signs, no invisible characters."""
    if text.isascii():
        return text
    whole = unicodedata.normalize("NFKC", text).translate(_TWINS)
    shown = (sign for sign in whole if unicodedata.category(sign) != "Cf")
    return "".join(str(unicodedata.decimal(sign, sign)) for sign in shown)


def difference(word: str, other: str) -> str:
    """Describe the character by which two words that look equal differ; empty if they do not look equal."""
    if word == other or typed(word) != typed(other):
        return ""
    if unicodedata.normalize("NFC", word) == unicodedata.normalize("NFC", other):
        return "they look the same, but one of them stores its accents as separate characters: type the word again"
    return next(_odd(word), "") or next((f"there {said}" for said in _odd(other)), "")


def other_sign(text: str) -> str:
    """Describe the first look-alike character in a text; empty for a text without any."""
    return next(_odd(text), "")


def _odd(text: str) -> Iterator[str]:
    """Yield a description of each look-alike character, once."""
    for sign in dict.fromkeys(text):
        if typed(sign) == sign or sign.isascii():
            continue
        code = f"U+{ord(sign):04X} {unicodedata.name(sign, '')}".strip()
        if not (meant := typed(sign)):
            yield f"it contains an invisible character, {code}"
        elif sign.isalpha():
            yield f"`{sign}` is a different letter from `{meant}`: {code}"
        elif sign.isdigit():
            yield f"`{sign}` is a different digit from `{meant}`: {code}"
        elif meant == "-":
            yield f"`{sign}` is not the minus sign `-`: {code}"
        else:
            yield f"`{sign}` is a different character from `{meant}`: {code}"
