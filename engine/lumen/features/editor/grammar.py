"""The grammar of names in files, which maps a node's path to the kind of name in its key or value."""

from collections.abc import Mapping
from functools import lru_cache

from lumen.features.editor.names import NameKind
from lumen.language.diagnostics import NodePath
from lumen.language.verbs import VERBS
from lumen.project.words import ANYHOW

MAX_REMEMBERED_PATHS = 50_000

Table = Mapping[tuple[str, ...], NameKind]
"""The kinds of names by the end of a path; `*` matches any key, and list indices are left out."""


def _pair_names() -> Table:
    """Return the kinds of names in the keys below verbs, as in `track: {head: false}`."""
    return {(verb.name, "*"): NameKind(verb.fields[0].names) for verb in VERBS if verb.pair}


def _field_names() -> Table:
    """Return the kinds of names in verbs' fields; the first field's value can also follow the verb directly."""
    found: dict[tuple[str, ...], NameKind] = {}
    for verb in VERBS:
        for i, field in enumerate(verb.fields):
            if field.names:
                found[verb.name, field.name] = NameKind(field.names)
                if i == 0 and not verb.mapped:
                    found[(verb.name,)] = NameKind(field.names)
    return found


_WORD_LANGUAGES: Table = {
    ("phrases", "*", "*"): NameKind.LANGUAGE,
    ("phrases", "*"): NameKind.LANGUAGE,
    ("value", "*"): NameKind.LANGUAGE,
}
_WORD_TABLES: Table = {("phrases", "*"): NameKind.PHRASE, ("answers", "*"): NameKind.ANSWERS}

_KEYS: Mapping[str, Table] = {
    "behavior": {
        ("states", "*"): NameKind.STATE,
        ("on", "*"): NameKind.EVENT,
        ("hears", "*"): NameKind.ROW,
        ("assign", "*"): NameKind.CONTEXT,
        ("say", "*"): NameKind.LANGUAGE,
        **_pair_names(),
        **_WORD_LANGUAGES,
    },
    "words": _WORD_LANGUAGES,
    "knowledge": {("questions", "*"): NameKind.LANGUAGE, ("answer", "*"): NameKind.LANGUAGE},
    "questions": {("asked", "*", "*"): NameKind.LANGUAGE, ("unanswered", "*"): NameKind.LANGUAGE},
    "lumen": {(way, "routes", "*"): NameKind.ROUTE for way in ("mqtt", "osc", "dmx")},
    "story": {("context", "*"): NameKind.CONTEXT},
    "controller": {("sweep", "*"): NameKind.JOINT, ("ahead", "*"): NameKind.JOINT},
    "motion": {("joints", "*"): NameKind.JOINT, ("handles", "*"): NameKind.JOINT},
    "body": {("postures", "*", "*"): NameKind.JOINT, ("shared", "*"): NameKind.JOINT},
}
_ROOT_KEYS: Mapping[str, Table] = {
    "behavior": {
        ("context", "*"): NameKind.CONTEXT,
        ("types", "*"): NameKind.CONTEXT,
        **_WORD_TABLES,
        ("events", "*"): NameKind.EVENT,
    },
    "words": _WORD_TABLES,
    "lumen": {("routes", "*"): NameKind.ROUTE, ("places", "*"): NameKind.PLACE},
    "motion": {("poses", "*"): NameKind.POSE},
    "body": {("joints", "*"): NameKind.JOINT, ("postures", "*"): NameKind.POSTURE},
}
_VALUES: Mapping[str, Table] = {
    "behavior": {
        ("on", "*"): NameKind.STATE,
        ("hears", "*"): NameKind.STATE,
        ("after", "*"): NameKind.STATE,
        ("at", "*"): NameKind.STATE,
        ("assign", "*"): NameKind.EXPRESSION,
        ("input", "*"): NameKind.EXPRESSION,
        ("say", "*"): NameKind.TEMPLATE,
        ("say",): NameKind.TEMPLATE,
        ("log",): NameKind.TEMPLATE,
        ("guard",): NameKind.EXPRESSION,
        ("if",): NameKind.EXPRESSION,
        ("output",): NameKind.EXPRESSION,
        ("properties", "*", "*"): NameKind.EXPRESSION,
        ("always",): NameKind.STATE,
        ("onDone",): NameKind.STATE,
        ("onError",): NameKind.STATE,
        ("target",): NameKind.STATE,
        ("initial",): NameKind.STATE,
        ("onReload",): NameKind.STATE,
        **_field_names(),
        ("publish",): NameKind.ROUTE,
        ("publish", "route"): NameKind.ROUTE,
        ("raise",): NameKind.EVENT,
        ("raise", "event"): NameKind.EVENT,
        ("send",): NameKind.EVENT,
        ("send", "event"): NameKind.EVENT,
        ("buttons", "event"): NameKind.EVENT,
        ("invoke",): NameKind.BEHAVIOR,
        ("invoke", "behavior"): NameKind.BEHAVIOR,
        ("words",): NameKind.WORDS,
    },
    "story": {
        ("expect", "state"): NameKind.STATE,
        ("properties", "*", "*"): NameKind.EXPRESSION,
        ("never",): NameKind.STATE,
        ("played",): NameKind.MOTION,
        ("expect", "place"): NameKind.PLACE,
        ("published",): NameKind.ROUTE,
        ("published", "route"): NameKind.ROUTE,
        ("message", "route"): NameKind.ROUTE,
        ("touch",): NameKind.SENSOR,
        ("release",): NameKind.SENSOR,
        ("event",): NameKind.EVENT,
        ("event", "name"): NameKind.EVENT,
        ("answers", "raise"): NameKind.EVENT,
        ("behavior",): NameKind.BEHAVIOR,
        ("language",): NameKind.LANGUAGE,
    },
    "knowledge": {("place",): NameKind.PLACE},
    "function": {("expression",): NameKind.EXPRESSION},
    "lumen": {
        ("behavior",): NameKind.BEHAVIOR,
        ("story",): NameKind.STORY,
        ("model",): NameKind.MODEL,
        ("languages",): NameKind.LANGUAGE,
        ("schema",): NameKind.MESSAGE,
        ("event",): NameKind.EVENT,
    },
    "controller": {
        ("bind", "inputs", "*"): NameKind.FIELD,
        ("bind", "outputs", "*"): NameKind.FIELD,
        ("message",): NameKind.FIELD,
        ("joint",): NameKind.JOINT,
        ("event",): NameKind.EVENT,
    },
    "motion": {
        ("start",): NameKind.POSTURE,
        ("end",): NameKind.POSTURE,
        ("posture",): NameKind.POSTURE,
        ("pose",): NameKind.POSE,
        ("play",): NameKind.MOTION,
    },
    "body": {
        ("parts", "*"): NameKind.JOINT,
        ("coupled", "joint"): NameKind.JOINT,
        ("coupled", "on"): NameKind.JOINT,
        ("shared", "*"): NameKind.JOINT,
        ("tactile",): NameKind.SENSOR,
    },
}
_DEFINING = {
    "behavior": frozenset(("context", "phrases", "answers", "events")),
    "words": frozenset(("phrases", "answers")),
    "lumen": frozenset(("routes", "languages", "places")),
    "motion": frozenset(("poses",)),
    "body": frozenset(("joints", "postures", "tactile")),
}
_SAYINGS = (NameKind.BEHAVIOR, NameKind.STATE, NameKind.ROW, NameKind.LANGUAGE)
"""The kinds of names in the nested keys of a sayings file, the outermost first."""
_DATA = {"behavior": ("data", "body"), "story": ("data", "body"), "lumen": (), "controller": ()}
_OPAQUE = frozenset(("context", "types", "events", "phrases", "answers", "renamed"))
"""Top-level keys of a behaviour below which texts contain no names."""


@lru_cache(maxsize=MAX_REMEMBERED_PATHS)
def key_kind(kind: str, path: NodePath) -> NameKind | None:
    """Return the kind of name in the key at the end of a path, in a file of that kind; None if it is not a name."""
    steps = _steps(path)
    if kind == "sayings":
        return _SAYINGS[len(steps) - 1] if len(steps) <= len(_SAYINGS) else None
    if kind == "behavior" and steps[:1] in (("types",), ("events",)) and len(steps) > 2:
        return None
    if steps[:1] == ("phrases",) and steps[-1] == ANYHOW:
        return None
    if found := _found(_ROOT_KEYS.get(kind, {}), steps, whole=True):
        return found
    if _in_data(kind, steps[:-1]):
        return NameKind.FIELD if len(steps) > 1 and steps[-2] in _DATA[kind] else None
    return _found(_KEYS.get(kind, {}), steps)


@lru_cache(maxsize=MAX_REMEMBERED_PATHS)
def value_kind(kind: str, path: NodePath) -> NameKind | None:
    """Return the kind of name in the text at a path, in a file of that kind; None if it contains no names."""
    steps = _steps(path)
    if kind == "behavior":
        if steps[:1] and steps[0] in _OPAQUE:
            return None
        if _in_data(kind, steps):
            return NameKind.EXPRESSION
    elif _in_data(kind, steps):
        return None
    return _found(_VALUES.get(kind, {}), steps)


def names_verb(kind: str, path: NodePath) -> bool:
    """Return True if the key at a path can be a skill's name, because a verb or a skill's outcome is expected there."""
    steps = [step for step in path[:-1] if isinstance(step, str)]
    if kind == "story":
        return steps[-1:] in (["skills"], ["did"]) or steps == ["robot"]
    if kind == "motion":
        return steps[-1:] == ["keyframes"]
    while steps and steps[-1] in ("then", "else", "parallel", "ask"):
        steps.pop()
    return kind == "behavior" and steps[-1:] in (["do"], ["entry"], ["exit"], ["actions"])


def defines(kind: str, path: NodePath, what: NameKind) -> bool:
    """Return True if a name of the kind `what` at that path is a definition."""
    steps = _steps(path)
    if kind == "behavior" and what is NameKind.STATE:
        return steps[-2:-1] == ("states",)
    if kind == "behavior" and what is NameKind.EVENT and {"raise", "send"} & {*steps[-2:]}:
        return True
    if kind == "lumen" and what is NameKind.EVENT:
        return True
    depth = 1 if what in (NameKind.SENSOR, NameKind.LANGUAGE) else 2
    return len(steps) == depth and steps[0] in _DEFINING.get(kind, frozenset()) and what is not NameKind.MESSAGE


def _in_data(kind: str, steps: tuple[str, ...]) -> bool:
    return any(name in steps[1:] for name in _DATA.get(kind, ()))


def _steps(path: NodePath) -> tuple[str, ...]:
    return tuple(step for step in path if isinstance(step, str))


def _found(table: Table, steps: tuple[str, ...], *, whole: bool = False) -> NameKind | None:
    """Return the kind of the longest entry that matches the end of the path, or the `whole` path; None without one.

    The longest one counts, because `on: {play: …}` is not a motion.
    """
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
