"""Parse XML into a tree of elements with line numbers; entities and document types of hostile files are refused."""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from xml.parsers import expat

from lumen.language.diagnostics import Place
from lumen.project.formats.conversion_findings import broken, check_size

MAX_XML_LEVELS = 100
"""The maximum nesting depth of elements."""

MAX_XML_ELEMENTS = 50_000
"""The maximum number of elements in a file, if a format sets no other limit."""

_XML = "http://www.w3.org/XML/1998/namespace"
_TAG = re.compile(rb"<[^\s/>]+")
_ATTRIBUTE = re.compile(rb"""\s+([^\s=>]+)\s*=\s*(?:"[^"]*"|'[^']*')""")


@dataclass(slots=True)
class XmlElement:
    """An element; its tag is a plain name in the namespace given to `parse_xml`, `{namespace}name` in any other.

    Names of attributes have the same form. `text` is the characters directly inside, without those of children.
    """

    tag: str
    attributes: Mapping[str, str]
    place: Place
    children: list["XmlElement"] = field(default_factory=list)
    parts: list[str] = field(default_factory=list)
    source: bytes = field(default=b"", repr=False)
    """The bytes of the whole file; empty if they are unknown."""
    start: int = 0
    """The offset of the element's tag in `source` [bytes]."""

    @property
    def text(self) -> str:
        return "".join(self.parts)

    def get(self, name: str, otherwise: str = "") -> str:
        """Return the value of an attribute, or `otherwise` if it is absent, without surrounding whitespace."""
        return self.attributes.get(name, otherwise).strip()

    def attribute_place(self, name: str) -> Place:
        """Return the place of an attribute's name; that of the element if the name is not found, as in UTF-16."""
        tag = _TAG.match(self.source, self.start)
        local = name.rpartition("}")[2].encode()
        at = tag.end() if tag else len(self.source)
        while match := _ATTRIBUTE.match(self.source, at):
            if match[1].rpartition(b":")[2] == local and (b":" in match[1]) == name.startswith("{"):
                before = self.source[self.start : match.start(1)].decode("utf-8", "replace")
                line, end = self.place.line + before.count("\n"), len(match[1].decode("utf-8", "replace"))
                first = 0 if "\n" in before else self.place.column - 1
                column = first + len(before.rpartition("\n")[2]) + 1
                return Place(self.place.file, line, column, line, column + end)
            at = match.end()
        return self.place

    def of(self, *tags: str) -> Iterator["XmlElement"]:
        """Return the children with one of these tags."""
        return (child for child in self.children if child.tag in tags)

    def walk(self) -> Iterator["XmlElement"]:
        """Yield the element itself and all below it, in document order."""
        yield self
        for child in self.children:
            yield from child.walk()


def parse_xml(file: str, content: bytes, namespace: str = "", *, most: int = MAX_XML_ELEMENTS) -> XmlElement:
    """Return the root of a file with at most `most` elements.

    Raises ForeignFileError if the file is not XML, is too large, or has a document type or entities. Tags of
    `namespace`, and tags without a namespace, have only their local names. Attributes such as `xml:id` are left out.
    """
    check_size(file, content)
    return _XmlReader(file, namespace, most).read(content)


class _XmlReader:
    """The handlers of Expat; `open` are the elements that have begun and not ended, from the root down."""

    def __init__(self, file: str, namespace: str, most: int) -> None:
        self.file, self.namespaces, self.most = file, ("", namespace), most
        self.parser = expat.ParserCreate(namespace_separator=" ")
        self.open: list[XmlElement] = []
        self.root: XmlElement | None = None
        self.count = 0
        self.source = b""

    def read(self, content: bytes) -> XmlElement:
        parser = self.parser
        self.source = content
        parser.buffer_text = True
        parser.StartElementHandler = self.start
        parser.EndElementHandler = self.end
        parser.CharacterDataHandler = self.characters
        parser.StartDoctypeDeclHandler = self.refuse
        parser.EntityDeclHandler = self.refuse
        try:
            parser.Parse(content, True)
        except expat.ExpatError as error:
            place = self.place(error.lineno, error.offset)
            raise broken(place, "not-xml", f"this is not XML: {expat.ErrorString(error.code)}") from None
        except (LookupError, ValueError, UnicodeError):
            hint = "save it as UTF-8"
            raise broken(Place(self.file), "not-xml", "the file's encoding is unknown", hint) from None
        assert self.root is not None  # else expat would have raised an error
        return self.root

    def place(self, line: int, column: int) -> Place:
        return Place(self.file, line, column + 1, line, column + 2)

    @property
    def here(self) -> Place:
        return self.place(self.parser.CurrentLineNumber, self.parser.CurrentColumnNumber)

    def refuse(self, *_: object) -> None:
        hint = "delete the `<!DOCTYPE …>`"
        raise broken(self.here, "not-xml", "the file has a document type or entities, which are not allowed", hint)

    def start(self, name: str, attributes: dict[str, str]) -> None:
        self.count += 1
        if len(self.open) >= MAX_XML_LEVELS or self.count > self.most:
            what = (
                f"more than {MAX_XML_LEVELS} levels"
                if len(self.open) >= MAX_XML_LEVELS
                else f"more than {self.most:,} elements"
            )
            raise broken(self.here, "too-large", f"the file is too large: it has {what}")
        known = {self.local(key): value for key, value in attributes.items() if not key.startswith(_XML)}
        here, start = self.here, self.parser.CurrentByteIndex
        element = XmlElement(self.local(name), known, here, source=self.source, start=start)
        if self.open:
            self.open[-1].children.append(element)
        else:
            self.root = element
        self.open.append(element)

    def end(self, name: str) -> None:
        self.open.pop()

    def characters(self, text: str) -> None:
        self.open[-1].parts.append(text)

    def local(self, name: str) -> str:
        namespace, _, local = name.rpartition(" ")
        return local if namespace in self.namespaces else f"{{{namespace}}}{local}"
