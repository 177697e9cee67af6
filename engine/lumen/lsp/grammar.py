"""What may stand where in a file: from the path of a node to the kind of name that its key or its value is."""

from collections.abc import Mapping
from pathlib import PurePosixPath

from lumen.language.diagnostics import NodePath
from lumen.loading.packaged import MAIN_FILE
from lumen.lsp.words import Kind

FILES: Mapping[str, str] = {
    "behaviors": "behavior",
    "behaviors/stories": "story",
    "fuzzy": "controller",
    "motions": "motion",
    "models": "body",
    "models/passages": "motion",
    "schemas/messages": "message",
}
"""The folders and the kinds of file in them, as the schemas call those."""

Table = Mapping[tuple[str, ...], Kind]
"""The ends of paths, `*` for any step; the indices of lists are left out."""

_KEYS: Mapping[str, Table] = {
    "behavior": {
        ("states", "*"): Kind.STATE,
        ("on", "*"): Kind.EVENT,
        ("assign", "*"): Kind.CONTEXT,
        ("say", "*"): Kind.LANGUAGE,
        ("track", "*"): Kind.CONTROLLER,
        ("phrases", "*", "*"): Kind.LANGUAGE,
        ("phrases", "*"): Kind.LANGUAGE,
        ("value", "*"): Kind.LANGUAGE,
    },
    "story": {("context", "*"): Kind.CONTEXT},
    "controller": {("sweep", "*"): Kind.JOINT, ("ahead", "*"): Kind.JOINT},
    "motion": {("joints", "*"): Kind.JOINT, ("handles", "*"): Kind.JOINT},
    "body": {("postures", "*", "*"): Kind.JOINT, ("shared", "*"): Kind.JOINT},
}
_ROOT_KEYS: Mapping[str, Table] = {
    "behavior": {
        ("context", "*"): Kind.CONTEXT,
        ("types", "*"): Kind.CONTEXT,
        ("phrases", "*"): Kind.PHRASE,
        ("answers", "*"): Kind.ANSWERS,
        ("events", "*"): Kind.EVENT,
    },
    "lumen": {("routes", "*"): Kind.ROUTE},
    "motion": {("poses", "*"): Kind.POSE},
    "body": {("joints", "*"): Kind.JOINT, ("postures", "*"): Kind.POSTURE},
}
_VALUES: Mapping[str, Table] = {
    "behavior": {
        ("on", "*"): Kind.STATE,
        ("after", "*"): Kind.STATE,
        ("assign", "*"): Kind.EXPRESSION,
        ("input", "*"): Kind.EXPRESSION,
        ("say", "*"): Kind.TEMPLATE,
        ("say",): Kind.TEMPLATE,
        ("log",): Kind.TEMPLATE,
        ("guard",): Kind.EXPRESSION,
        ("if",): Kind.EXPRESSION,
        ("output",): Kind.EXPRESSION,
        ("always",): Kind.STATE,
        ("onDone",): Kind.STATE,
        ("onError",): Kind.STATE,
        ("target",): Kind.STATE,
        ("initial",): Kind.STATE,
        ("onReload",): Kind.STATE,
        ("play",): Kind.MOTION,
        ("posture",): Kind.POSTURE,
        ("posture", "name"): Kind.POSTURE,
        ("track",): Kind.CONTROLLER,
        ("publish",): Kind.ROUTE,
        ("publish", "route"): Kind.ROUTE,
        ("raise",): Kind.EVENT,
        ("raise", "event"): Kind.EVENT,
        ("send",): Kind.EVENT,
        ("send", "event"): Kind.EVENT,
        ("language",): Kind.LANGUAGE,
        ("invoke",): Kind.BEHAVIOR,
        ("invoke", "behavior"): Kind.BEHAVIOR,
    },
    "story": {
        ("expect", "state"): Kind.STATE,
        ("never",): Kind.STATE,
        ("played",): Kind.MOTION,
        ("published",): Kind.ROUTE,
        ("published", "route"): Kind.ROUTE,
        ("message", "route"): Kind.ROUTE,
        ("touch",): Kind.SENSOR,
        ("release",): Kind.SENSOR,
        ("event",): Kind.EVENT,
        ("event", "name"): Kind.EVENT,
        ("behavior",): Kind.BEHAVIOR,
        ("language",): Kind.LANGUAGE,
    },
    "lumen": {
        ("behavior",): Kind.BEHAVIOR,
        ("story",): Kind.STORY,
        ("model",): Kind.MODEL,
        ("languages",): Kind.LANGUAGE,
        ("schema",): Kind.MESSAGE,
        ("event",): Kind.EVENT,
    },
    "controller": {("bind", "inputs", "*"): Kind.FIELD, ("joint",): Kind.JOINT},
    "motion": {
        ("start",): Kind.POSTURE,
        ("end",): Kind.POSTURE,
        ("posture",): Kind.POSTURE,
        ("pose",): Kind.POSE,
        ("play",): Kind.MOTION,
    },
    "body": {
        ("parts", "*"): Kind.JOINT,
        ("coupled", "joint"): Kind.JOINT,
        ("coupled", "on"): Kind.JOINT,
        ("shared", "*"): Kind.JOINT,
        ("tactile",): Kind.SENSOR,
    },
}
_DEFINING = {
    "behavior": frozenset(("context", "phrases", "answers", "events")),
    "lumen": frozenset(("routes", "languages")),
    "motion": frozenset(("poses",)),
    "body": frozenset(("joints", "postures", "tactile")),
}
_DATA = {"behavior": ("data", "body"), "story": ("data", "body"), "lumen": (), "controller": ()}
_OPAQUE = frozenset(("context", "types", "events", "phrases", "answers", "renamed"))
"""Roots of a behaviour below which texts stand for themselves."""


def kind_of(file: str) -> str:
    """The kind of a project's file, as `schemas/KIND.schema.json` calls it; empty where it is none."""
    if file == MAIN_FILE:
        return "lumen"
    path = PurePosixPath(file)
    return FILES.get(str(path.parent), "") if path.suffix in (".yaml", ".json") else ""


def key_kind(kind: str, path: NodePath) -> Kind | None:
    """What the key at the end of a path names, in a file of that kind."""
    steps = _steps(path)
    if kind == "behavior" and steps[:1] in (("types",), ("events",)) and len(steps) > 2:
        return None
    if found := _found(_ROOT_KEYS.get(kind, {}), steps, whole=True):
        return found
    if _in_data(kind, steps[:-1]):
        return Kind.FIELD if len(steps) > 1 and steps[-2] in _DATA[kind] else None
    return _found(_KEYS.get(kind, {}), steps)


def value_kind(kind: str, path: NodePath) -> Kind | None:
    """What the text at a path names, in a file of that kind."""
    steps = _steps(path)
    if kind == "behavior":
        if steps[:1] and steps[0] in _OPAQUE:
            return None
        if _in_data(kind, steps):
            return Kind.EXPRESSION
    elif _in_data(kind, steps):
        return None
    return _found(_VALUES.get(kind, {}), steps)


def defines(kind: str, path: NodePath, what: Kind) -> bool:
    """Whether the name at that path is where the thing is made known."""
    steps = _steps(path)
    if kind == "behavior" and what is Kind.STATE:
        return steps[-2:-1] == ("states",)
    if kind == "behavior" and what is Kind.EVENT and {"raise", "send"} & {*steps[-2:]}:
        return True
    if kind == "lumen" and what is Kind.EVENT:
        return True
    depth = 1 if what in (Kind.SENSOR, Kind.LANGUAGE) else 2
    return len(steps) == depth and steps[0] in _DEFINING.get(kind, frozenset()) and what is not Kind.MESSAGE


def _in_data(kind: str, steps: tuple[str, ...]) -> bool:
    return any(name in steps[1:] for name in _DATA.get(kind, ()))


def _steps(path: NodePath) -> tuple[str, ...]:
    return tuple(step for step in path if isinstance(step, str))


def _found(table: Table, steps: tuple[str, ...], *, whole: bool = False) -> Kind | None:
    """The entry whose end matches; one that says more of the path wins, as `on: {play: …}` is no motion."""
    lengths = (len(steps),) if whole else (3, 2, 1)
    for length in lengths:
        end = steps[-length:]
        if len(end) < length:
            continue
        if found := table.get(end):
            return found
        if length > 1 and (found := table.get((*end[:-1], "*"))):
            return found
        if length > 2 and (found := table.get((end[0], "*", "*"))):
            return found
    return None
