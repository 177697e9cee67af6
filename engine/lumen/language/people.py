"""Compare names of people, find them in texts and remove them."""

import re
import unicodedata
from collections.abc import Iterable, Mapping
from typing import Any

_SPACELESS = (
    ("\u0e00", "\u0eff"),
    ("\u1000", "\u109f"),
    ("\u1780", "\u17ff"),
    ("\u3040", "\u30ff"),
    ("\u3400", "\u9fff"),
    ("\uac00", "\ud7af"),
)
"""The first and last character of each script without spaces between words, or with endings joined to names."""
_CLUSTER = re.compile(r"\s+|.", re.DOTALL)


def name_key(name: str) -> str:
    """Return a name in the form used for comparisons: NFKC, case folded, no invisible characters, single spaces.

    All forms of the Turkish letter i are equal: `IŞIK` and `ipek` from another keyboard mean `Işık` and `İpek`.
    """
    return " ".join(_folded(name).split())


class PersonName:
    """A person's name, which is found in texts as whole words, whatever its case and its form in Unicode.

    `others` are the keys of other names. If one of them contains this name, as `ana maria` contains `ana`, its
    occurrences do not count. An empty name is in no text.
    """

    def __init__(self, name: str, others: Iterable[str] = ()) -> None:
        self.key = name_key(name)
        longer = sorted((other for other in others if other != self.key), key=len, reverse=True)
        words = [*(_words(other) for other in longer if other), f"(?P<name>{_words(self.key)})"]
        self._pattern = re.compile("|".join(words)) if self.key else None

    def is_named_in(self, text: str) -> bool:
        """Return True if the text contains the name."""
        return bool(self._spans(name_key(text)))

    def taken_from(self, text: str) -> str:
        """Return the text without the name; unchanged if it does not contain the name.

        A changed text is in NFC, without spaces at its ends, and empty if the name can't be cut out of it.
        """
        while self.is_named_in(text):
            shorter = self._cut(unicodedata.normalize("NFC", text))
            if shorter == text:
                return ""  # it can't be cut out of these characters: better no text than the name
            text = shorter
        return text

    def scrubbed(self, data: Any) -> Any:
        """Return JSON data without the name; the same object if the name is not in it."""
        scrubbed: Any
        match data:
            case str():
                return self.taken_from(data) if self.is_named_in(data) else data
            case Mapping():
                scrubbed = {self.scrubbed(key): self.scrubbed(value) for key, value in data.items()}
            case list() | tuple():
                scrubbed = type(data)(map(self.scrubbed, data))
            case _:
                return data
        return data if scrubbed == data else scrubbed

    def is_in(self, data: Any) -> bool:
        """Return True if JSON data names the person anywhere."""
        match data:
            case str():
                return self.is_named_in(data)
            case Mapping():
                return any(self.is_in(key) or self.is_in(value) for key, value in data.items())
            case list() | tuple():
                return any(map(self.is_in, data))
        return False

    def _cut(self, text: str) -> str:
        folded, places = _mapped(text)
        kept, at = [], 0
        for first, last in self._spans(folded):
            kept.append(text[at : places[first]])
            at = places[last]
        return "".join([*kept, text[at:]]).strip() if kept else text

    def _spans(self, folded: str) -> list[tuple[int, int]]:
        """Return the spans in a folded text that name the person."""
        found = self._pattern.finditer(folded) if self._pattern else ()
        return [match.span() for match in found if match["name"] is not None]


def _folded(text: str) -> str:
    if text.isascii():
        return text.lower()
    text = text.encode("utf-8", "replace").decode()  # half of a surrogate pair, which JSON may contain
    folded = unicodedata.normalize("NFKC", unicodedata.normalize("NFKC", text).casefold())
    shown = "".join(sign for sign in folded if unicodedata.category(sign) not in ("Cf", "Mn") or _accent(sign))
    return shown.replace("i\u0307", "i").replace("ı", "i")


def _accent(sign: str) -> bool:
    """Return True if a character is a combining mark other than a variation selector, which only selects a glyph."""
    return unicodedata.category(sign) == "Mn" and not "\ufe00" <= sign <= "\ufe0f"


def _mapped(text: str) -> tuple[str, list[int]]:
    """Return the folded text, and for each of its characters the offset in `text`, with the end as a last offset."""
    folded, places = [], []
    starts = [match.start() for match in _CLUSTER.finditer(text)]
    starts = [at for at in starts if unicodedata.category(text[at]) not in ("Mn", "Cf", "Mc", "Me")]
    for start, end in zip(starts, [*starts[1:], len(text)], strict=False):
        piece = " " if text[start].isspace() else _folded(text[start:end])
        folded.append(piece)
        places += [start] * len(piece)
    return "".join(folded), [*places, len(text)]


def _words(key: str) -> str:
    """Return a pattern for a key as whole words."""
    before = "" if not key or _is_spaceless(key[0]) else r"(?<!\w)"
    after = "" if not key or _is_spaceless(key[-1]) else r"(?!\w)"
    return before + re.escape(key) + after


def _is_spaceless(character: str) -> bool:
    return any(first <= character <= last for first, last in _SPACELESS)
