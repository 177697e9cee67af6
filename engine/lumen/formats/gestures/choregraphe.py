"""Choregraphe's `.xar` behaviours: the joint curves of one of their timelines.

Aldebaran's project format 3: `Timeline fps` > `ActuatorList` > `ActuatorCurve actuator unit` > `Key frame value` >
`Tangent side abscissaParam ordinateParam interpType`. Unit 0 is degrees, 1 a hand's opening; frame / fps is a time.
"""

from collections.abc import Iterator
from math import radians

from lumen.formats.conversion_findings import ConversionFindings, broken
from lumen.formats.gestures.joint_curves import BezierHandle, CurvePoint, JointCurves, number
from lumen.formats.xml_elements import XmlElement, parse_xml
from lumen.language.diagnostics import did_you_mean

MAX_CHOREGRAPHE_ELEMENTS = 1_000_000
"""In a project, boxes and curves together."""

DEFAULT_FPS = 25.0
"""Frames a second of a timeline that names none."""

Timelines = dict[str, XmlElement]


def read_choregraphe(file: str, content: bytes, findings: ConversionFindings, timeline: str = "") -> JointCurves:
    """The curves of the timeline of that name; of the only one without a name. Raises ForeignFileError."""
    root = parse_xml(file, content, most=MAX_CHOREGRAPHE_ELEMENTS)
    if _tag(root) != "ChoregrapheProject":
        raise broken(root.place, "not-a-motion", f"this is no behaviour of Choregraphe: it begins with `{_tag(root)}`")
    timelines = dict(_timelines(root))
    chosen = _chosen(root, timelines, timeline)
    _others(root, chosen, findings, asked=bool(timeline))
    fps = _pace(chosen, findings)
    curves: dict[str, list[CurvePoint]] = {}
    for curve in _under(chosen, "ActuatorCurve"):
        joint = curve.get("actuator")
        if curve.get("mute") == "1":
            findings.lost(curve.place, f"`{joint}` is muted")
        elif joint in curves:
            findings.lost(curve.place, f"`{joint}` has a curve already")
        elif points := list(_points(curve, fps, findings)):
            curves[joint] = points
    return curves


def _pace(timeline: XmlElement, findings: ConversionFindings) -> float:
    """How many of its frames are a second."""
    fps = number(timeline.get("fps"))
    if fps is not None and fps > 0:
        return fps
    findings.changed(
        timeline.place, f"the timeline has no `fps` above 0: {DEFAULT_FPS:g} frames are taken for a second"
    )
    return DEFAULT_FPS


def _chosen(root: XmlElement, timelines: Timelines, name: str) -> XmlElement:
    if not timelines:
        raise broken(root.place, "not-a-motion", "no timeline in it moves a joint")
    if name in timelines:
        return timelines[name]
    if name:
        hint = did_you_mean(name, timelines, "it has")
        raise broken(root.place, "not-a-motion", f"there is no timeline `{name}`", hint)
    if len(timelines) > 1:
        names = ", ".join(f"`{n}`" for n in timelines)
        raise broken(root.place, "not-a-motion", f"it has several timelines: {names}", "choose one: --timeline NAME")
    return next(iter(timelines.values()))


def _timelines(element: XmlElement, box: str = "") -> Iterator[tuple[str, XmlElement]]:
    """The timelines that move joints, by the names of their boxes; a name that comes again has a number."""
    found: dict[str, int] = {}
    for name, timeline in _all_timelines(element, box):
        if timeline.get("enable") != "0" and any(_tag(key) == "Key" for key in timeline.walk()):
            found[name] = found.get(name, 0) + 1
            yield (f"{name} {found[name]}" if found[name] > 1 else name), timeline


def _all_timelines(element: XmlElement, box: str) -> Iterator[tuple[str, XmlElement]]:
    waiting = [(element, box)]
    while waiting:
        here, box = waiting.pop()
        if _tag(here) == "Timeline" and any(_tag(child) == "ActuatorList" for child in here.children):
            yield box, here
        box = here.get("name") if _tag(here) == "Box" else box
        waiting.extend((child, box) for child in reversed(here.children))


def _others(root: XmlElement, chosen: XmlElement, findings: ConversionFindings, *, asked: bool) -> None:
    """List the boxes that do something else; beside a timeline that was asked for they are nothing to be missed."""
    inside = {id(element) for element in chosen.walk()}
    for box in root.walk():
        around = any(element is chosen or _tag(element) == "Box" for element in list(box.walk())[1:])
        if _tag(box) == "Box" and (id(box) in inside or not around):
            say = findings.changed if asked and id(box) not in inside else findings.lost
            say(box.place, f"box `{box.get('name')}` is left out: only joints of a timeline are read")


def _points(curve: XmlElement, fps: float, findings: ConversionFindings) -> Iterator[CurvePoint]:
    factor = 1.0 if curve.get("unit") == "1" else radians(1.0)
    for key in _under(curve, "Key"):
        frame, value = number(key.get("frame")), number(key.get("value"))
        if frame is None or value is None:
            findings.lost(key.place, f"a key of `{curve.get('actuator')}` has no frame or no value")
            continue
        tangents = {tangent.get("side"): tangent for tangent in _under(key, "Tangent")}
        kinds = {tangent.get("interpType") for tangent in tangents.values()}
        if "constant" in kinds:
            findings.changed(key.place, f"`{curve.get('actuator')}` jumps here; no joint does, so it goes in a line")
        left = tangents.get("left")
        straight = left is not None and left.get("interpType") in ("linear", "constant")
        into, out = (_handle(tangents.get(side), fps, factor) for side in ("left", "right"))
        yield CurvePoint(frame / fps, value * factor, key.place, straight, into, out)


def _handle(tangent: XmlElement | None, fps: float, factor: float) -> BezierHandle:
    """(dt [s], da [rad]) of a tangent; none where it is not a Bezier's."""
    if tangent is None or tangent.get("interpType") != "bezier":
        return 0.0, 0.0
    frames, value = number(tangent.get("abscissaParam")), number(tangent.get("ordinateParam"))
    return ((frames or 0.0) / fps, (value or 0.0) * factor)


def _under(element: XmlElement, tag: str) -> Iterator[XmlElement]:
    """The elements of that tag that belong to it, not to a box inside."""
    waiting = list(reversed(element.children))
    while waiting:
        here = waiting.pop()
        if _tag(here) == tag:
            yield here
        elif _tag(here) != "Box":
            waiting.extend(reversed(here.children))


def _tag(element: XmlElement) -> str:
    return element.tag.rpartition("}")[2]
