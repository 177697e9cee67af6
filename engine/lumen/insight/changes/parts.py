"""The changes between two versions of a controller, a function, a motion or a route."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from typing import Any

from lumen.insight.changes.change import Change, Risk, code, names, seconds
from lumen.language.controllers import ControllerDefinition
from lumen.language.functions import FunctionDefinition
from lumen.language.motions import MotionDefinition
from lumen.language.routes import Route


def controller_changes(old: ControllerDefinition, new: ControllerDefinition) -> Iterator[Change]:
    """Yield the changes of a controller: rules, variables and terms are named one by one."""
    for sentence in _controller(old, new):
        yield Change("controller", new.name, sentence, Risk.MOTION, f"fuzzy/{new.name}.yaml")


def function_changes(old: FunctionDefinition, new: FunctionDefinition) -> Iterator[Change]:
    """Yield the changes of arguments and expression, with both versions; descriptions and examples are cosmetic."""
    title, file = f"function `{new.name}`", f"functions/{new.name}.yaml"
    if list(old.parameters.items()) != list(new.parameters.items()):
        sentence = f"{title} is now called as {code(new.signature)}, not {code(old.signature)}"
        if old.signature == new.signature:
            sentence = f"{title} accepts other kinds of arguments"
        yield Change("function", new.name, sentence, Risk.BEHAVIOR, file)
    if old.expression != new.expression:
        sentence = f"{title} is now {code(new.expression)}, not {code(old.expression)}"
        yield Change("function", new.name, sentence, Risk.BEHAVIOR, file)
    for what, before, after in (
        ("another description", old.description, new.description),
        ("other examples", old.examples, new.examples),
    ):
        if before != after:
            yield Change("function", new.name, f"{title} has {what}", Risk.COSMETIC, file)


def motion_changes(old: MotionDefinition, new: MotionDefinition) -> Iterator[Change]:
    """Yield the changes of duration, joints, tracks, cues and postures."""
    for sentence in _motion(old, new):
        yield Change("motion", new.name, f"motion `{new.name}` {sentence}", Risk.MOTION, f"motions/{new.name}.yaml")


def route_changes(old: Route, new: Route) -> Iterator[Change]:
    """Yield a change for each setting that differs: `route `say` ttl 5 s → 3 s`."""
    for field, shown in _ROUTE.items():
        before, after = getattr(old, field), getattr(new, field)
        if before != after:
            sentence = f"route `{new.name}` {field} {shown(before)} → {shown(after)}"
            yield Change("route", new.name, sentence, Risk.WIRING, "lumen.yaml")


def _shown(value: Any) -> str:
    return "none" if value in (None, "") else code(value)


_ROUTE: Mapping[str, Callable[[Any], str]] = {
    "key": _shown,
    "of": _shown,
    "content_type": _shown,
    "direction": _shown,
    "schema": _shown,
    "event": _shown,
    "every": seconds,
    "size": lambda value: "the camera's" if value is None else str(value),
    "ttl": seconds,
    "keep": lambda value: "none" if value is None else str(value),
    "carried": _shown,
    "must_arrive": lambda value: "yes" if value else "no",
    "latency": seconds,
    "most": lambda value: "the usual" if value is None else f"{value:g}/s",
}


def _controller(old: ControllerDefinition, new: ControllerDefinition) -> Iterator[str]:
    title = f"`{new.name}`"
    for i, (before, after) in enumerate(zip(old.rules, new.rules, strict=False), 1):
        if replace(before, text="") != replace(after, text=""):
            yield f"fuzzy rule {i} of {title} changed: {code(after.text)}"
    if len(old.rules) != len(new.rules):
        yield f"{title} now has {len(new.rules)} fuzzy rules, not {len(old.rules)}"
    yield from _variables(old, new, title)
    if [block.operators for block in old.blocks] != [block.operators for block in new.blocks]:
        yield f"{title} combines its rules differently"
    if _bound(old) != _bound(new):
        yield f"the bindings of {title} changed"
    if old.tracking != new.tracking:
        fields = [f for f in type(new.tracking).__slots__ if getattr(old.tracking, f) != getattr(new.tracking, f)]
        yield f"the tracking of {title} changed: {names(fields)}"


def _bound(controller: ControllerDefinition) -> tuple[object, ...]:
    return controller.input_bindings, controller.context_inputs, controller.output_bindings, controller.signals


def _variables(old: ControllerDefinition, new: ControllerDefinition, title: str) -> Iterator[str]:
    before, after = {**old.inputs, **old.outputs}, {**new.inputs, **new.outputs}
    for name in dict.fromkeys((*before, *after)):
        if name not in before or name not in after:
            yield f"variable `{name}` of {title} {'added' if name in after else 'removed'}"
        elif before[name].terms != after[name].terms:
            terms, now = before[name].terms, after[name].terms
            changed = [term for term in dict.fromkeys((*terms, *now)) if terms.get(term) != now.get(term)]
            yield f"{names(changed)} of `{name}` in {title} changed"
        elif before[name] != after[name]:
            yield f"`{name}` of {title} changed"


def _motion(old: MotionDefinition, new: MotionDefinition) -> Iterator[str]:
    longer = new.duration - old.duration
    if abs(longer) > 1e-9:
        yield f"is {seconds(round(abs(longer), 6))} {'longer' if longer > 0 else 'shorter'}"
    if more := [joint for joint in new.tracks if joint not in old.tracks]:
        yield f"also moves {names(more)}"
    if fewer := [joint for joint in old.tracks if joint not in new.tracks]:
        yield f"no longer moves {names(fewer)}"
    if other := [joint for joint in new.tracks if joint in old.tracks and old.tracks[joint] != new.tracks[joint]]:
        shown = names(other) if len(other) <= 3 else f"{len(other)} joints"
        yield f"moves {shown} differently"
    if old.cues != new.cues:
        yield "has other cues"
    if (old.start, old.end) != (new.start, new.end):
        yield "begins or ends in a different posture"
