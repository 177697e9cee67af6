"""Reads an SCXML document as the data of a behaviour file."""

import re
from pathlib import PurePosixPath
from typing import Any

from lumen.features.formats_charts.ecmascript import ScriptError
from lumen.features.formats_charts.foreign_states import ForeignState, passing_key
from lumen.features.formats_charts.scxml.action_reader import PROCESSORS, LeftOutError, ScxmlActionReader, own
from lumen.features.formats_charts.scxml.data_model import ScxmlDataModel
from lumen.features.formats_charts.scxml.namespaces import LUMEN_NAMESPACE, SCXML_NAMESPACE
from lumen.features.formats_charts.scxml.state_tree import ScxmlStateTree, regular
from lumen.features.formats_charts.scxml.transition_reader import ScxmlTransitionReader
from lumen.features.formats_charts.scxml.unread import UnreadParts
from lumen.language.diagnostics import Diagnostic
from lumen.language.machines import RESUME_WORDS
from lumen.project.formats.behavior_data import ActionData, single
from lumen.project.formats.conversion_findings import ConversionFindings, broken
from lumen.project.formats.durations import milliseconds
from lumen.project.formats.unused_names import unused_name
from lumen.project.formats.xml_elements import XmlElement, parse_xml

_NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_-]*")
_ID = re.compile(r"[^\s@*]+")


def invocation(element: XmlElement, contents: ScxmlActionReader) -> dict[str, Any]:
    """Convert an `<invoke>` to a row of `invoke`, for the behaviour with the file's name.

    Raises LeftOutError or ScriptError if it can't be converted.
    """
    kind, source = element.get("type"), element.get("src").removeprefix("file:")
    if kind.rstrip("/") not in {p.rstrip("/") for p in PROCESSORS} or "typeexpr" in element.attributes:
        raise LeftOutError(f"the service `{kind or element.get('typeexpr')}` is not carried over")
    if "srcexpr" in element.attributes or not source:
        raise LeftOutError("a computed or inline chart is not carried over", "save the chart in its own file")
    if "idlocation" in element.attributes:
        raise LeftOutError("`idlocation` has no counterpart in Lumen", "write `id` instead")
    name = PurePosixPath(source).stem
    if not _NAME.fullmatch(name):
        raise LeftOutError(f"`{source}` can't be the name of a behaviour", "rename the file")
    row: dict[str, Any] = {"behavior": name}
    id = element.get("id")
    if id and not _ID.fullmatch(id):
        raise LeftOutError(f"`{id}` can't be an id in Lumen")
    if id and id != name:
        row["id"] = id
    if data := contents.data(element):
        row["input"] = data
    return row


def read_scxml(file: str, content: bytes, title: str) -> tuple[dict[str, Any], list[Diagnostic]]:
    """Return the data of a behaviour file, and findings about lost and changed parts.

    `title` is the behaviour's name if the document has none. Raises ForeignFileError if the file is not an SCXML
    document with states.
    """
    root = parse_xml(file, content, SCXML_NAMESPACE)
    if root.tag != "scxml":
        name = root.tag.rpartition("}")[2]
        if name == "scxml":
            hint = f'write xmlns="{SCXML_NAMESPACE}"'
            raise broken(root.place, "not-scxml", "<scxml> is not in W3C's namespace", hint)
        raise broken(root.place, "not-scxml", f"the file begins with <{name}>, not with <scxml>")
    return _ScxmlReader(root, title).data()


class _ScxmlReader:
    """Reads one document, from the outermost state to the innermost."""

    def __init__(self, scxml: XmlElement, title: str) -> None:
        self.scxml = scxml
        self.findings = ConversionFindings()
        UnreadParts(scxml, self.findings)
        self.outline = ScxmlStateTree(scxml, title, self.findings)
        self.context = ScxmlDataModel(self.outline, self.findings)
        self.contents = ScxmlActionReader(self.context, self.findings)
        self.transitions = ScxmlTransitionReader(self.outline, self.contents, self.findings)
        self.passed: dict[ForeignState, dict[str, Any]] = {}
        self.given = {element.get("id") for element in scxml.walk() if element.tag == "invoke"}
        """The invocation ids in the file."""
        self.invoked: dict[str, _ActiveTogether] = {}
        """The states with the invocations read so far, by invocation id."""

    def data(self) -> tuple[dict[str, Any], list[Diagnostic]]:
        root = self.outline.root
        if not regular(root):
            raise broken(self.scxml.place, "not-scxml", "the chart has no states")
        data: dict[str, Any] = {"id": self.outline.title} if self.outline.title else {}
        own_data = self._own(self.scxml, "machine", {})
        if self.context.first:
            data["context"] = self.context.first
        if types := {**self.context.wide, **own_data.pop("types", {})}:
            data["types"] = types
        data.update(own_data)
        data.update(self._state(root))
        late = [{"assign": {key: source}} for key, source in self.context.late.items()]
        if late:
            data = _with_entry(data, late)
        return data, self.findings.diagnostics

    def _own(self, element: XmlElement, name: str, otherwise: Any) -> Any:
        for found in element.of(f"{{{LUMEN_NAMESPACE}}}{name}"):
            try:
                return own(found)
            except LeftOutError as error:
                self.findings.lost(found.place, error.message)
        return otherwise

    def _state(self, node: ForeignState) -> dict[str, Any]:
        data: dict[str, Any] = {}
        if node.parent and node.id and (node.id != node.path or node.id == self.outline.title):
            data["id"] = node.id
        if node.source.tag == "history":
            return {**data, **self._history(node)}
        if node.source.tag == "final":
            data["type"] = "final"
        elif node.source.tag == "parallel" and regular(node):
            data["type"] = "parallel"
        elif regular(node):
            data["initial"] = self._initial(node)
        data.update(self._behaviour(node))
        if regular(node):
            data["states"] = {child.key: self._state(child) for child in node.children} | self._passed(node)
        elif node.source.get("initial") or any(node.source.of("initial")):
            message = f"`initial` of `{node.name}` is left out: the state has no inner states"
            place = next((e.place for e in node.source.of("initial")), node.source.attribute_place("initial"))
            self.findings.lost(place, message, "delete it")
        return data

    def _history(self, node: ForeignState) -> dict[str, Any]:
        data: dict[str, Any] = {"type": "history"}
        if node.source.get("type") == "deep":
            data["history"] = "deep"
        if transition := next(node.source.of("transition"), None):
            self._plain_way(transition)
            data.update(self._default(node, transition, "target"))
        return data if "target" in data else data | self._remembered(node)

    def _remembered(self, node: ForeignState) -> dict[str, Any]:
        """Return the default `target` of a history that lacks the one that SCXML requires.

        It is the parent's first regular child, or all of them in a parallel state.
        """
        home = node.parent
        found = regular(home)[: None if home.source.tag == "parallel" else 1] if home else []
        return {"target": self.transitions.named(node, found)} if found else {}

    def _plain_way(self, transition: XmlElement) -> None:
        """Report attributes that a transition in an `<initial>` or `<history>` can't have."""
        for name in ("event", "cond", "type"):
            if name in transition.attributes:
                message = f"`{name}` is left out: a transition into a state has no event or condition"
                self.findings.lost(transition.attribute_place(name), message, "delete it")

    def _default(self, node: ForeignState, transition: XmlElement, key: str) -> dict[str, Any]:
        """Return the transition's targets under `key`; report invalid targets and return an empty map.

        Actions move to an additional state. In a parallel state, they are reported and left out.
        """
        home = node if key == "initial" else node.parent
        found = self.transitions.targets(transition)
        if found is None or not found:
            return {}
        wrong = next((t for t in found if home is None or not t.lies_below(home)), None)
        if wrong is not None:
            self.findings.lost(transition.place, f"`{wrong.name}` is not inside `{home.name if home else ''}`")
            return {}
        if key == "target" and any(target.source.tag == "history" for target in found):
            self.findings.lost(transition.place, "a history can't lead to a history", "name a state")
            return {}
        actions = self.contents.block(transition.children)
        if actions and home is not None and home.source.tag != "parallel":
            return {key: self._pass_through(home, transition, found, actions)}
        if actions:
            self.findings.lost(
                transition.place,
                "actions on the way into a parallel state are left out",
                "move them to `<onentry>` of the state",
            )
        return {key: self.transitions.named(node, found, inside=key == "initial")}

    def _pass_through(
        self, home: ForeignState, transition: XmlElement, targets: list[ForeignState], actions: list[ActionData]
    ) -> str:
        """Add a state to `home` that runs the actions and immediately enters the targets; return its key."""
        passed = self.passed.setdefault(home, {})
        key = passing_key(home, passed)
        hint = "the behaviour passes through it immediately"
        self.findings.changed(transition.place, f"these actions become a separate state, `{key}`", hint)
        pretended = ForeignState(transition, home, key, "", "")
        passed[key] = {"always": {"target": self.transitions.named(pretended, targets), "actions": actions}}
        return key

    def _passed(self, home: ForeignState) -> dict[str, Any]:
        return self.passed.get(home, {})

    def _initial(self, node: ForeignState) -> Any:
        for element in node.source.of("initial"):
            for transition in element.of("transition"):
                self._plain_way(transition)
                found = self._default(node, transition, "initial")
                if found:
                    return found["initial"]
        if ids := node.source.get("initial").split():
            pretended = XmlElement("transition", {"target": " ".join(ids)}, node.source.place)
            found = self._default(node, pretended, "initial")
            if found:
                return found["initial"]
        return self.transitions.named(node, [regular(node)[0]], inside=True)

    def _behaviour(self, node: ForeignState) -> dict[str, Any]:
        data: dict[str, Any] = {}
        afters = self._afters(node)
        for key, tag in (("entry", "onentry"), ("exit", "onexit")):
            own_blocks = set(map(id, afters[tag]))
            blocks = [e for e in node.source.of(tag) if id(e) not in own_blocks]
            if actions := [action for block in blocks for action in self.contents.block(block.children)]:
                data[key] = actions
            self._several(blocks)
        for key in ("do", "buttons"):
            if own_data := self._own(node.source, key, []):
                data[key] = own_data
        if invokes := self._invokes(node):
            data["invoke"] = single(invokes)
        data.update(self.transitions.of(node, afters["events"]))
        if node.source.tag == "final" and (output := self._output(node)) is not None:
            data["output"] = output
        return data | self._ours(node)

    def _ours(self, node: ForeignState) -> dict[str, Any]:
        """Return the data in `<lumen:state>`, which only Lumen writes; report invalid entries."""
        data: dict[str, Any] = {}
        ours = self._own(node.source, "state", {})
        for key, value in ours.items() if isinstance(ours, dict) else (("", ours),):
            if key == "onReload" and isinstance(value, str) and (home := self.outline.by_id.get(value)):
                data[key] = node.calls(home, self.outline.title)
            elif key == "resume" and value in RESUME_WORDS:
                data[key] = value
            else:
                place = next(node.source.of(f"{{{LUMEN_NAMESPACE}}}state")).place
                self.findings.lost(place, f"`{key}: {value}` of `<lumen:state>` has no counterpart in Lumen")
        return data

    def _invokes(self, node: ForeignState) -> list[dict[str, Any]]:
        """Convert a state's invocations of charts in other files; report and leave out all others."""
        rows = []
        for element in node.source.of("invoke"):
            try:
                rows.append(self._named_apart(node, element, invocation(element, self.contents)))
            except (LeftOutError, ScriptError) as error:
                id = element.get("id")
                hint = (
                    f"invoke a behaviour with the id `{id}`: transitions on `done.invoke.{id}` are kept" if id else ""
                )
                self.findings.lost(element.place, f"`<invoke>`: {error}", hint)
                continue
            for part in (e for e in element.of("finalize") if e.children):
                hint = "do it in a transition on the event"
                self.findings.lost(part.place, "`<finalize>` has no counterpart in Lumen", hint)
            message = f"`<invoke>` of `{element.get('src')}` becomes the behaviour `{rows[-1]['behavior']}`"
            hint = "import that file too"
            if element.get("autoforward") != "true":
                hint += '; the behaviour receives all events from outside, as with `autoforward="true"`'
            self.findings.changed(element.place, message, hint)
        return rows

    def _named_apart(self, node: ForeignState, element: XmlElement, row: dict[str, Any]) -> dict[str, Any]:
        """Return the row with an id that is unique among simultaneous invocations.

        Raises LeftOutError if the file repeats an id among them.
        """
        id = row.get("id", row["behavior"])

        def is_taken(name: str) -> bool:
            return name in self.invoked and self.invoked[name].meets(node)

        if element.get("id") and is_taken(id):
            raise LeftOutError(f"a second `<invoke>` has the id `{id}`")
        if not element.get("id"):
            many = len(self.given) + len(self.invoked)
            if (free := unused_name(id, lambda name: name in self.given or is_taken(name), many)) != id:
                id = row["id"] = free
        self.invoked.setdefault(id, _ActiveTogether()).add(node)
        return row

    def _several(self, blocks: list[XmlElement]) -> None:
        for block in blocks[:-1]:
            if any(e.tag not in ("raise", "log", "cancel") for e in block.children):
                hint = "if an action of the first one fails, the second one is skipped too"
                self.findings.changed(block.place, f"several `<{block.tag}>` become one list", hint)

    def _afters(self, node: ForeignState) -> dict[str, Any]:
        """Return the blocks that Lumen wrote for `after`, under `onentry` and `onexit`.

        `events` maps the event of each timer to its delay.
        """
        found: dict[str, Any] = {"onentry": [], "onexit": [], "events": {}}
        name = node.name or self.outline.title
        exits: dict[str, list[XmlElement]] = {}
        for block in (b for b in node.source.of("onexit") if len(b.children) == 1):
            exits.setdefault(block.children[0].get("sendid"), []).append(block)
        for block in node.source.of("onentry"):
            send = block.children[0] if len(block.children) == 1 else None
            if send is None or send.tag != "send" or not send.get("id").startswith("after."):
                continue
            text = send.get("id").removeprefix("after.").removesuffix(f".{name}")
            cancels = exits.get(send.get("id"), [])
            whole = set(send.attributes) == {"event", "id", "delay"} and not send.children
            whole = whole and milliseconds(send.get("delay")) == milliseconds(text)
            if f"after.{text}.{name}" == send.get("event") == send.get("id") and cancels and whole:
                found["onentry"].append(block)
                found["onexit"] += cancels
                found["events"][send.get("event")] = text
        return found

    def _output(self, node: ForeignState) -> Any:
        for element in node.source.of("donedata"):
            try:
                return self.contents.data(element)
            except (LeftOutError, ScriptError) as error:
                self.findings.lost(element.place, f"the data of `{node.name}` is left out: {error}")
        return None


class _ActiveTogether:
    """A set of states; `meets` returns whether a given state can be active together with any of them.

    Two states can if one contains the other, or if they are in different regions of a parallel state.
    """

    def __init__(self) -> None:
        self._states: set[ForeignState] = set()
        self._around: dict[ForeignState, set[ForeignState]] = {}
        """The ancestors of the states, each with its children on the path to a state."""

    def add(self, state: ForeignState) -> None:
        self._states.add(state)
        while state.parent is not None:
            self._around.setdefault(state.parent, set()).add(state)
            state = state.parent

    def meets(self, state: ForeignState) -> bool:
        if state in self._states or state in self._around:
            return True
        while (parent := state.parent) is not None:
            others = len(self._around.get(parent, ())) - (state in self._around.get(parent, ()))
            if parent in self._states or (others and parent.source.tag == "parallel"):
                return True
            state = parent
        return False


def _with_entry(data: dict[str, Any], late: list[ActionData]) -> dict[str, Any]:
    """Return the data with `late` as the first actions of `entry`.

    The values of `late` must be computed before all other actions.
    """
    entry = [*late, *data.pop("entry", [])]
    return {**{k: v for k, v in data.items() if k != "states"}, "entry": entry, "states": data["states"]}
