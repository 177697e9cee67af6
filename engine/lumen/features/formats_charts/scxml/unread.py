"""Reports and removes the parts of a document that the reader ignores: nothing is lost silently."""

from lumen.features.formats_charts.scxml.known import (
    ACTION_HOLDERS,
    ALTERNATIVES,
    ATTRIBUTES,
    ELEMENTS,
    MEANINGLESS_ELEMENTS,
    OPEN,
    REQUIRED,
    SINGLE,
    TEXT,
    VALUES,
    plain,
)
from lumen.project.formats.conversion_findings import ConversionFindings
from lumen.project.formats.known import Known
from lumen.project.formats.xml_elements import XmlElement

_NOTHING = Known()
_TEXTS = OPEN | {"script"}
_READ_DATA_MODELS = ("", "ecmascript", "null")
_OF_DATA = frozenset(("data", "assign", "script"))
_SCHEMA_LOCATION = "{http://www.w3.org/2001/XMLSchema-instance}schemaLocation"


class UnreadParts:
    """Prepares one document for the reader.

    Elements that can't be read are removed from the tree, and attribute values that differ only in case are corrected.
    Elements of editors are reported once per name.
    """

    def __init__(self, scxml: XmlElement, findings: ConversionFindings) -> None:
        self.findings = findings
        self.passive = {
            child.tag
            for element in scxml.walk()
            if element.tag in ELEMENTS and element.tag not in ACTION_HOLDERS
            for child in element.children
            if _is_foreign(child.tag)
        }
        """Foreign elements that also occur outside executable content, so they are never actions."""
        self.notes: dict[str, list[XmlElement]] = {}
        self._element(scxml)
        self._data_model(scxml)
        for tag, elements in self.notes.items():
            namespace, name = tag[1:].rsplit("}", 1)
            times = f", {len(elements)} times" if len(elements) > 1 else ""
            message = f"`<{name}>` of the namespace `{namespace}` is ignored{times}"
            self.findings.changed(elements[0].place, message, "notes and layouts of editors are not carried over")
            for part in (part for element in elements for part in element.walk() if part.tag in ATTRIBUTES):
                self.findings.lost(
                    part.place, f"`<{part.tag}>` in `<{name}>` is not read", f"move it out of `<{name}>`"
                )

    def _element(self, element: XmlElement) -> None:
        self._attributes(element)
        if element.tag not in OPEN:
            element.children[:] = [child for child in element.children if self._is_read(element, child)]
        self._contradictions(element)
        if element.text.strip() and element.tag not in _TEXTS and not element.tag.startswith("{"):
            self.findings.lost(element.place, f"the text in `<{element.tag}>` has no counterpart in Lumen", "delete it")
        for child in element.children if element.tag not in OPEN else ():
            self._element(child)

    def _attributes(self, element: XmlElement) -> None:
        shown, known = plain(element.tag), ATTRIBUTES.get(plain(element.tag), _NOTHING)
        foreign = [name for name in element.attributes if _is_foreign(name) and name != _SCHEMA_LOCATION]
        for name in foreign:
            namespace, local = name[1:].rsplit("}", 1)
            message = f"`{local}` of the namespace `{namespace}` is ignored"
            self.findings.changed(element.attribute_place(name), message)
        own = {plain(name): name for name in element.attributes if not _is_foreign(name)}
        for name, hint in known.losses(own):
            message, hint = _lost(known, f"`{name}` of `<{shown}>`", name, hint)
            self.findings.lost(element.attribute_place(own[name]), message, hint)
        for name, key in own.items():
            if allowed := VALUES.get((shown, name)):
                self._value(element, key, f"`{name}` of `<{shown}>`", allowed)
        if (needed := REQUIRED.get(shown)) and not element.get(needed):
            self.findings.lost(element.place, f"a `<{shown}>` has no `{needed}`", f'write {needed}="…"')

    def _value(self, element: XmlElement, key: str, shown: str, allowed: tuple[str, ...]) -> None:
        value = element.get(key)
        if value in allowed:
            return
        place, found = element.attribute_place(key), {k: v for k, v in element.attributes.items() if k != key}
        if value.lower() in allowed:
            found[key] = value.lower()
            self.findings.changed(place, f"{shown} is read as `{value.lower()}`", f'write "{value.lower()}"')
        else:
            choice = " or ".join(f'"{word}"' for word in allowed)
            self.findings.lost(place, f"{shown} can't be `{value}`", f"write {choice}")
        element.attributes = found

    def _is_read(self, element: XmlElement, child: XmlElement) -> bool:
        """Return whether a child can be read; otherwise report it, or note an editor's element for later."""
        shown, name = plain(element.tag), plain(child.tag)
        if _is_foreign(child.tag):
            local = child.tag.rpartition("}")[2]
            if element.tag not in ACTION_HOLDERS or child.tag in self.passive or local in MEANINGLESS_ELEMENTS:
                self.notes.setdefault(child.tag, []).append(child)
            else:
                self.findings.lost(child.place, f"`<{local}>` has no counterpart in Lumen")
            return False
        known = ELEMENTS.get(shown, _NOTHING)
        losses = list(known.losses([name]))
        for _, hint in losses:
            elsewhere = name in ATTRIBUTES and name not in known.lost
            message, hint = _lost(known, f"`<{name}>`" + (f" in `<{shown}>`" if elsewhere else ""), name, hint)
            hint = hint.replace("mean `", "mean `<").replace("`?", ">`?")
            if shown in ("elseif", "else"):
                hint = f"move it after `<{shown}/>`"
            self.findings.lost(child.place, message, hint)
        return not losses

    def _contradictions(self, element: XmlElement) -> None:
        shown = plain(element.tag)
        seen: set[str] = set()
        for child in element.children:
            tag = plain(child.tag)
            single = (shown, tag) in SINGLE or (tag.startswith("lumen:") and tag != "lumen:action")
            if "else" in seen and tag in ("elseif", "else") and shown == "if":
                self.findings.lost(child.place, f"`<{tag}>` after `<else>` is never reached", "delete it")
            if single and tag in seen:
                self.findings.lost(
                    child.place, f"a second `<{tag}>` in a `<{shown}>` is left out", "delete one of them"
                )
            seen.add(tag)
        named: set[str] = set()
        for param in element.of("param"):
            if (name := param.get("name")) in named and name:
                self.findings.lost(
                    param.place, f"two `<param>` are named `{name}`: the last one is used", "delete one of them"
                )
            named.add(name)
        for names in ALTERNATIVES.get(shown, ()):
            given = [name for name in names if _has(element, name)]
            if len(given) > 1:
                parts = " and ".join(f"`{name}`" for name in given)
                self.findings.lost(
                    element.place, f"`<{shown}>` has {parts}: one of them is left out", "delete one of them"
                )

    def _data_model(self, scxml: XmlElement) -> None:
        kind, version = scxml.get("datamodel"), scxml.get("version")
        if version not in ("", "1.0"):
            message = f"version `{version}` is read as 1.0"
            self.findings.changed(scxml.attribute_place("version"), message, 'write "1.0", the only version')
        if kind.lower() == "null" and (part := next((e for e in scxml.walk() if e.tag in _OF_DATA), None)):
            message = f"the data model `null` does not allow `<{part.tag}>`: it is read as ECMAScript"
            self.findings.changed(scxml.attribute_place("datamodel"), message, 'write "ecmascript"')
        if kind.lower() not in _READ_DATA_MODELS:
            message = f"the data model `{kind}` is read as ECMAScript"
            self.findings.changed(scxml.attribute_place("datamodel"), message, "check each condition and value")


def _is_foreign(name: str) -> bool:
    return plain(name).startswith("{")


def _lost(known: Known, shown: str, name: str, hint: str) -> tuple[str, str]:
    """Return the message and the hint. For a known loss, the hint is the reason and becomes part of the message."""
    if name in known.lost:
        return f"{shown}: {hint}", ""
    return f"{shown} has no counterpart in Lumen", hint


def _has(element: XmlElement, name: str) -> bool:
    if name == TEXT:
        return bool(element.text.strip() or element.children)
    if name.startswith("<"):
        return any(element.of(name.strip("<>")))
    return name in element.attributes
