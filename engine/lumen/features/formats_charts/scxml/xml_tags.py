"""Writes XML as indented text."""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from xml.sax.saxutils import escape

_FORBIDDEN = re.compile("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_QUOTES = {'"': "&quot;", "\n": "&#10;", "\t": "&#9;", "\r": "&#13;"}


@dataclass
class XmlTag:
    """An element to write; empty attributes, and text beside children, are left out."""

    name: str
    attributes: Mapping[str, str] = field(default_factory=dict)
    children: "list[XmlTag]" = field(default_factory=list)
    text: str = ""

    def lines(self, depth: int = 0) -> Iterator[str]:
        """Yield the element's lines, indented by two spaces per level of `depth`."""
        indent = "  " * depth
        pairs = ((key, escape(_sound(value), _QUOTES)) for key, value in self.attributes.items() if value)
        start = " ".join([self.name, *(f'{key}="{value}"' for key, value in pairs)])
        if self.children:
            yield f"{indent}<{start}>"
            for child in self.children:
                yield from child.lines(depth + 1)
            yield f"{indent}</{self.name}>"
        elif self.text:
            yield f"{indent}<{start}>{escape(_sound(self.text))}</{self.name}>"
        else:
            yield f"{indent}<{start}/>"


def _sound(text: str) -> str:
    """Return the text with U+FFFD in place of characters that XML does not allow."""
    return _FORBIDDEN.sub("\ufffd", text)
