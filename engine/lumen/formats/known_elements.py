"""What a table of a format says of XML: attributes and elements that are not carried over, each at its place.

In a table the place is `<Key>`; it holds the names of attributes, and of elements as `<Tangent>`.
"""

from collections.abc import Callable

from lumen.formats.conversion_findings import ConversionFindings
from lumen.formats.known import FormatTable
from lumen.formats.xml_elements import XmlElement


def tell_losses(
    element: XmlElement,
    table: FormatTable,
    findings: ConversionFindings,
    within: Callable[[XmlElement], bool] = lambda _: True,
) -> None:
    """List what of an element, and of those within that the table has a place for, is not carried over.

    Of elements for which `within` is false only the name is looked at.
    """
    waiting = [element]
    while waiting:
        here = waiting.pop()
        tag = local(here)
        known = table[f"<{tag}>"]
        for name, hint in known.losses(here.attributes):
            findings.lost(here.place, f"`{name[:60]}` of `<{tag}>` is left out", hint)
        for child in here.children:
            name = f"<{local(child)}>"
            for _, hint in known.losses([name]):
                findings.lost(child.place, f"`{name[:60]}` in `<{tag}>` is left out", hint)
            if name in known.read and name in table and within(child):
                waiting.append(child)


def local(element: XmlElement) -> str:
    """The element's name without its namespace."""
    return element.tag.rpartition("}")[2]
