"""Find attributes and elements of XML that are not carried over, with the table of a format.

The key of an element in the table is `<Key>`; its entry names attributes, and elements as `<Tangent>`.
"""

from collections.abc import Callable

from lumen.project.formats.conversion_findings import ConversionFindings
from lumen.project.formats.known import FormatTable
from lumen.project.formats.xml_elements import XmlElement


def tell_losses(
    element: XmlElement,
    table: FormatTable,
    findings: ConversionFindings,
    within: Callable[[XmlElement], bool] = lambda _: True,
) -> None:
    """Report the attributes and child elements that the table does not carry over, at every depth that it covers.

    Children whose names have an entry in the table are searched too. If `within` returns False for a child, only the
    child's name is checked.
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
    """Return the element's name without its namespace."""
    return element.tag.rpartition("}")[2]
