"""The SCXML that the importer recognizes: W3C's recommendation of 2015, and older forms that are still in use."""

from collections.abc import Mapping

from lumen.features.formats_charts.scxml.namespaces import LUMEN_NAMESPACE
from lumen.project.formats.known import FormatTable, Known

_FINAL = "nothing follows a final state"
_ENTERED = "a parallel state enters all of its states"
_PROCESSOR = "write `type`"
_ONE_FILE = "other files are not read"

ATTRIBUTES: FormatTable = {
    "scxml": Known(
        frozenset(("initial", "name", "datamodel", "binding", "version")),
        {"initialstate": "write `initial`", "profile": "write `datamodel`"},
        {"exmode": "only for other interpreters"},
    ),
    "state": Known(
        frozenset(("id", "initial", "lumen:root", "lumen:key")),
        {"final": "write `<final>`", "src": _ONE_FILE, "task": "Lumen has no tasks"},
    ),
    "parallel": Known(frozenset(("id", "lumen:root", "lumen:key")), {"initial": _ENTERED, "src": _ONE_FILE}),
    "final": Known(frozenset(("id", "lumen:key", "lumen:end"))),
    "history": Known(frozenset(("id", "type", "lumen:key"))),
    "initial": Known(meaningless={"id": "nothing can refer to it"}),
    "transition": Known(
        frozenset(("event", "cond", "target", "type", "lumen:hears", "lumen:end")),
        {"guard": "write `cond`", "condition": "write `cond`", "next": "write `target`", "anchor": "write a history"},
        {"id": "nothing can refer to it"},
    ),
    "onentry": Known(),
    "onexit": Known(),
    "datamodel": Known(lost={"src": "write the data here", "schema": "data is not checked against a schema"}),
    "data": Known(frozenset(("id", "src", "expr")), {"name": "write `id`"}),
    "donedata": Known(),
    "param": Known(frozenset(("name", "expr", "location"))),
    "content": Known(frozenset(("expr",))),
    "invoke": Known(
        frozenset(("type", "typeexpr", "src", "srcexpr", "id", "idlocation", "namelist", "autoforward")),
        {"targettype": _PROCESSOR},
    ),
    "finalize": Known(),
    "script": Known(frozenset(("src",))),
    "raise": Known(frozenset(("event",))),
    "if": Known(frozenset(("cond",))),
    "elseif": Known(frozenset(("cond",))),
    "else": Known(),
    "log": Known(frozenset(("label", "expr")), meaningless={"level": "Lumen's log has one level"}),
    "assign": Known(
        frozenset(("location", "expr")),
        {"name": "write `location`", "type": "XML can't be assigned", "attr": "XML can't be assigned"},
    ),
    "send": Known(
        frozenset(
            ("event", "eventexpr", "target", "targetexpr", "type", "typeexpr", "id", "idlocation", "delay", "delayexpr",
             "namelist")
        ),
        {"sendid": "write `id`", "targettype": _PROCESSOR, "hints": "hints are not sent"},
    ),
    "cancel": Known(frozenset(("sendid", "sendidexpr"))),
    "lumen:machine": Known(),
    "lumen:do": Known(),
    "lumen:buttons": Known(),
    "lumen:state": Known(),
    "lumen:action": Known(),
}  # fmt: skip
"""The attributes of each element that are read, lost or meaningless."""

_ACTION_NAMES = frozenset(("raise", "send", "cancel", "log", "assign", "if", "script", "lumen:action"))
_OTHER_ACTIONS = {
    "foreach": "Lumen has no loops in actions",
    "var": "declare it with `<data>` and set it with `<assign>`",
    "event": "write `<raise>`",
    "validate": "data is not checked against a schema",
}
_ACTIONS = Known(_ACTION_NAMES, _OTHER_ACTIONS)
_SCRIPT = {"script": "Lumen does not run ECMAScript"}
_WITHIN_STATE = frozenset(
    ("state", "parallel", "history", "transition", "onentry", "onexit", "datamodel", "invoke", "lumen:do",
     "lumen:buttons", "lumen:state")
)  # fmt: skip
_PARAMETERS = frozenset(("param", "content"))

ELEMENTS: FormatTable = {
    "scxml": Known(
        frozenset(("state", "parallel", "final", "history", "initial", "transition", "onentry", "onexit", "datamodel",
                   "invoke", "lumen:machine", "lumen:do", "lumen:buttons", "lumen:state")),
        _SCRIPT,
    ),
    "state": Known(_WITHIN_STATE | {"final", "initial"}, _SCRIPT | {"anchor": "write a history"}),
    "parallel": Known(_WITHIN_STATE | {"final"}, _SCRIPT | {"initial": _ENTERED, "donedata": _FINAL}),
    "final": Known(
        frozenset(("onentry", "onexit", "donedata", "lumen:state")),
        dict.fromkeys(("state", "parallel", "final", "history"), "a `<final>` has no inner states")
        | {"transition": _FINAL, "invoke": _FINAL, "datamodel": "write it in `<scxml>`"},
    ),
    "history": Known(
        frozenset(("transition",)),
        dict.fromkeys(("state", "parallel", "final", "history"), "a `<history>` has no inner states"),
    ),
    "initial": Known(frozenset(("transition",))),
    "transition": Known(_ACTION_NAMES, _OTHER_ACTIONS | {"target": "write `target=` in the `<transition>`"}),
    "onentry": _ACTIONS,
    "onexit": _ACTIONS,
    "datamodel": Known(frozenset(("data",))),
    "donedata": Known(_PARAMETERS),
    "invoke": Known(_PARAMETERS | {"finalize"}),
    "finalize": Known(_ACTION_NAMES),
    "if": Known(_ACTION_NAMES | {"elseif", "else"}, _OTHER_ACTIONS),
    "send": Known(_PARAMETERS),
}  # fmt: skip
"""The child elements of each element; an element that is not listed contains none, or any XML (`OPEN`)."""

OPEN = frozenset(("data", "assign", "content"))
"""Elements that can contain any XML, which is not part of the chart."""

ACTION_HOLDERS = frozenset(tag for tag, known in ELEMENTS.items() if "raise" in known.read)
"""Elements whose children are executable content."""

MEANINGLESS_ELEMENTS = {
    "editorinfo": "the layout in Qt Creator",
    "layout": "the layout in an editor", "geometry": "the layout in an editor",
    "graphics": "the layout in an editor", "position": "the layout in an editor",
    "metadata": "notes for readers", "documentation": "notes for readers", "description": "notes for readers",
}  # fmt: skip
"""Elements of other namespaces that are never actions, with their purpose."""

VALUES: Mapping[tuple[str, str], tuple[str, ...]] = {
    ("scxml", "binding"): ("early", "late"),
    ("history", "type"): ("shallow", "deep"),
    ("transition", "type"): ("external", "internal"),
    ("invoke", "autoforward"): ("false", "true"),
    ("state", "lumen:root"): ("true",),
    ("parallel", "lumen:root"): ("true",),
    ("final", "lumen:end"): ("true",),
    ("transition", "lumen:end"): ("true",),
}
"""The allowed values of attributes that have a fixed set."""

SINGLE = frozenset(
    (("state", "initial"), ("initial", "transition"), ("history", "transition"), ("final", "donedata"),
     ("donedata", "content"), ("send", "content"), ("invoke", "content"))
)  # fmt: skip
"""Children that a parent can have only once, like every `lumen:` element except `lumen:action`."""

TEXT = "text"
ALTERNATIVES: Mapping[str, tuple[tuple[str, ...], ...]] = {
    "state": (("initial", "<initial>"),),
    "data": (("src", "expr", TEXT),),
    "assign": (("expr", TEXT),),
    "script": (("src", TEXT),),
    "content": (("expr", TEXT),),
    "param": (("expr", "location"),),
    "donedata": (("<param>", "<content>"),),
    "send": (
        ("event", "eventexpr"), ("target", "targetexpr"), ("type", "typeexpr"), ("id", "idlocation"),
        ("delay", "delayexpr"), ("namelist", "<content>"), ("<param>", "<content>"),
    ),
    "cancel": (("sendid", "sendidexpr"),),
    "invoke": (("type", "typeexpr"), ("src", "srcexpr", "<content>"), ("id", "idlocation")),
}  # fmt: skip
"""Groups of alternatives; the recommendation allows an element at most one from each group."""

REQUIRED: Mapping[str, str] = {"data": "id", "param": "name"}


def _place(tag: str) -> Known:
    """Return an element's attributes and, in angle brackets, its child elements."""
    own, within = ATTRIBUTES.get(tag, Known()), ELEMENTS.get(tag, Known())
    return Known(
        own.read | {f"<{name}>" for name in within.read},
        {**own.lost, **{f"<{name}>": why for name, why in within.lost.items()}},
        own.meaningless,
    )


KNOWN: FormatTable = {
    **{f"<{tag}>": _place(tag) for tag in ATTRIBUTES},
    "timer of an `after`": Known(meaningless={"…": "a second start or cancel has no effect"}),
    "any element": Known(meaningless={f"<{name}>": why for name, why in MEANINGLESS_ELEMENTS.items()}),
}


def plain(name: str) -> str:
    """Return a name with Lumen's namespace written as `lumen:`; any other name is unchanged."""
    return name.replace(f"{{{LUMEN_NAMESPACE}}}", "lumen:", 1)
