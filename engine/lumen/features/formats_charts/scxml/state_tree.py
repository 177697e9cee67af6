"""The states of an SCXML document, with Lumen's keys and paths, before their content is read."""

from lumen.features.formats_charts.foreign_states import MAX_STATE_LEVELS, ForeignState, clean_id, free_id, free_key
from lumen.features.formats_charts.scxml.namespaces import LUMEN_NAMESPACE
from lumen.project.formats.conversion_findings import ConversionFindings
from lumen.project.formats.xml_elements import XmlElement

STATES = ("state", "parallel", "final", "history")


def regular(node: ForeignState) -> list[ForeignState]:
    """Return the children that can be active: all except histories."""
    return [child for child in node.children if child.source.tag != "history"]


class ScxmlStateTree:
    """The tree of states under `root`, and all states by id.

    `top` is the root's element, which becomes the behaviour file; `title` is the behaviour's name.
    """

    def __init__(self, scxml: XmlElement, title: str, findings: ConversionFindings) -> None:
        self.findings = findings
        self.scxml = scxml
        self.ids = {e.get("id") for e in scxml.walk() if e.tag in STATES}
        self.top = self._top()
        name = scxml.get("name") if self.top is scxml else self.top.get("id")
        self.title = clean_id(name) or title
        self.by_id: dict[str, ForeignState] = {}
        self.given: set[str] = set()
        self.root = ForeignState(self.top, None, "", "", "")
        if self.top is not scxml and self.title:
            self.by_id[self.title] = self.root
        self._fill(self.root, 1)
        self.events = {
            f"done.state.{id}": f"done.state.{node.name}" for id, node in self.by_id.items() if id != node.name != ""
        }
        """Lumen's end events, by the document's end events, for states whose names differ."""

    def _top(self) -> XmlElement:
        """Return the `<scxml>`, or the state that Lumen wrote for a behaviour's root.

        Children of such a state that only end the document are removed.
        """
        states = [state for state in self.scxml.of(*STATES) if not _ends_document(state)]
        if len(states) != 1 or states[0].get(f"{{{LUMEN_NAMESPACE}}}root") != "true":
            return self.scxml
        states[0].children[:] = [child for child in states[0].children if not _ends_document(child)]
        return states[0]

    def _fill(self, parent: ForeignState, level: int) -> None:
        for element in parent.source.children:
            if element.tag not in STATES or not self._fits(element, level):
                continue
            node = self._node(element, parent)
            parent.add(node)
            if node.id:
                self.by_id[element.get("id")] = node
            self._fill(node, level + 1)
        if parent.children and not regular(parent):
            self.findings.lost(
                parent.source.place,
                f"the history of `{parent.name}` is left out: the state has no other inner states",
                "delete it",
            )
            for child in parent.children:
                self.by_id.pop(child.source.get("id"), None)
            parent.children.clear()

    def _fits(self, element: XmlElement, level: int) -> bool:
        id, place = element.get("id"), element.place
        message = hint = ""
        if level > MAX_STATE_LEVELS:
            message, hint = (
                f"`{id or element.tag}` is nested more than {MAX_STATE_LEVELS} levels deep",
                "use fewer levels",
            )
        elif id in self.by_id:
            message, hint = f"a second state has the id `{id}`", "give each state its own id"
        if message:
            self.findings.lost(place, message, hint)
        return not message

    def _node(self, element: XmlElement, parent: ForeignState) -> ForeignState:
        written = element.get("id")
        id = free_id(written, self.ids, self.given)
        self.given.add(id)
        if id != written:
            message = f"the state `{written}` is renamed to `{id}` in the whole behaviour"
            self.findings.changed(element.place, message, "an id can't contain spaces, `#` or `*`")
        stem = element.get(f"{{{LUMEN_NAMESPACE}}}key") or (id.removeprefix(f"{parent.path}.") if parent.path else id)
        key = free_key(parent, stem or element.tag, id, self.ids)
        return ForeignState(element, parent, key, id, parent.below(key))


def _ends_document(element: XmlElement) -> bool:
    """Return whether Lumen wrote the element only to end the document together with the wrapped root."""
    return element.get(f"{{{LUMEN_NAMESPACE}}}end") == "true"
