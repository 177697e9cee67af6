"""The defaults of MJCF: what an element's class says that the element does not."""

from lumen.features.formats_robots.mjcf_known import ACTUATORS
from lumen.project.formats.xml_elements import XmlElement

_MAIN = "main"


class Defaults:
    """The classes of a model: attributes of elements by class and tag, those of outer classes within."""

    def __init__(self, root: XmlElement) -> None:
        self._classes: dict[str, dict[str, dict[str, str]]] = {_MAIN: {}}
        for default in root.of("default"):
            self._read(default, {}, _MAIN)

    def _read(self, default: XmlElement, outer: dict[str, dict[str, str]], otherwise: str) -> None:
        name = default.get("class") or otherwise
        known = {tag: dict(attributes) for tag, attributes in outer.items()}
        for tag, attributes in self._classes.get(name, {}).items() if not outer else ():
            known.setdefault(tag, {}).update(attributes)
        for element in default.children:
            if element.tag != "default":
                known.setdefault(element.tag, {}).update(element.attributes)
        self._classes[name] = known
        for inner in default.of("default"):
            self._read(inner, known, name)

    def has(self, name: str) -> bool:
        """Whether the model has a class of that name; no name is the main one."""
        return not name or name in self._classes

    def whole(self, element: XmlElement, childclass: str = "") -> XmlElement:
        """The element with what its class, else that of the body around it, else the main one says."""
        name = element.get("class") or childclass or _MAIN
        known = self._classes.get(name, self._classes[_MAIN])
        given = dict(known.get(element.tag, {}))
        if element.tag in ACTUATORS:
            given = {**known.get("general", {}), **given}
        return XmlElement(element.tag, {**given, **element.attributes}, element.place, element.children)
