"""Numbers in attributes of a robot's model."""

from math import isfinite

from lumen.features.formats_robots.orientation import Vector
from lumen.project.formats.conversion_findings import ConversionFindings
from lumen.project.formats.xml_elements import XmlElement


class Numbers:
    """Reads attributes; invalid numbers are reported with their place and treated as missing."""

    def __init__(self, findings: ConversionFindings) -> None:
        self.findings = findings

    def all(self, element: XmlElement, name: str, count: int) -> tuple[float, ...] | None:
        """Return `count` numbers; None if the attribute is missing or invalid."""
        text = element.get(name)
        if not text:
            return None
        try:
            numbers = tuple(float(word) for word in text.replace(",", " ").split())
        except ValueError:
            numbers = ()
        if len(numbers) != count or not all(map(isfinite, numbers)):
            wanted = "a number" if count == 1 else f"{count} numbers"
            message = f'`{name}="{text[:40]}"` of `<{element.tag}>` is not {wanted}'
            self.findings.lost(element.place, message, "correct it in the model")
            return None
        return numbers

    def one(self, element: XmlElement, name: str) -> float | None:
        """Return one number, None if it is missing or invalid."""
        found = self.all(element, name, 1)
        return found[0] if found else None

    def vector(self, element: XmlElement, name: str, otherwise: Vector) -> Vector:
        """Return three numbers, or `otherwise`."""
        found = self.all(element, name, 3)
        return (found[0], found[1], found[2]) if found else otherwise
