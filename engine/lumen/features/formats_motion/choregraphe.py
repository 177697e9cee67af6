"""Reads the joint curves of one timeline in a Choregraphe behaviour (`.xar`).

Aldebaran's project format 3: `Timeline fps` > `ActuatorList` > `ActuatorCurve actuator unit` > `Key frame value` >
`Tangent side abscissaParam ordinateParam interpType`. A value is an angle in degrees, or a hand's opening from 0 to 1.
A frame divided by `fps` is a time [s]. Keys before the Start flag (`start_frame`) and after the End flag (`end_frame`,
-1 for none) are not played. Box libraries have the same form as projects.
"""

from collections.abc import Collection, Iterator
from math import inf, radians
from typing import NamedTuple

from lumen.language.diagnostics import did_you_mean
from lumen.project.formats.conversion_findings import ConversionFindings, ForeignFileError, broken
from lumen.project.formats.joint_curves import BezierHandle, CurvePoint, JointCurves, MotionFile, number
from lumen.project.formats.known import FormatTable, Known
from lumen.project.formats.known_elements import local, tell_losses
from lumen.project.formats.xml_elements import XmlElement, parse_xml

MAX_CHOREGRAPHE_ELEMENTS = 1_000_000
"""The most XML elements in a project."""

DEFAULT_FPS = 25.0
"""The frame rate of a timeline without a valid `fps` [1/s]."""

NAO_HANDS = ("LHand", "RHand")
ROOTS = ("ChoregrapheProject", "ChoregrapheBox")
VERSION = "3"

_DRAWING = "only for drawing the box"
_WIRES = "used only by boxes that are left out"
_BOX = Known(
    read=frozenset(("<Timeline>", "<Box>", "<script>")),
    meaningless={
        "name": "`--timeline` selects by it",
        "id": _WIRES, "localization": _DRAWING, "tooltip": _DRAWING, "x": _DRAWING, "y": _DRAWING, "plugin": _WIRES,
        "<bitmap>": _DRAWING, "<Input>": _WIRES, "<Output>": _WIRES, "<Parameter>": _WIRES, "<Resource>": _WIRES,
        "<Link>": _WIRES,
    },
)  # fmt: skip
KNOWN: FormatTable = {
    **{f"<{root}>": Known(frozenset(("xar_version", "<Box>"))) for root in ROOTS},
    "<Box>": _BOX,
    "<Timeline>": Known(
        read=frozenset(("enable", "fps", "start_frame", "end_frame", "<ActuatorList>", "<BehaviorLayer>")),
        meaningless={"size": "a motion ends at its last key"},
    ),
    "<Timeline> without curves": Known(meaningless={"enable": "it plays nothing"}),
    "<ActuatorCurve> without keys": Known(meaningless={"…": "without a key it moves nothing"}),
    "<Diagram> without boxes": Known(meaningless={"…": "without boxes it does nothing"}),
    "<Tangent> before a straight line": Known(meaningless={"…": "a straight line needs no tangent"}),
    "<script> without text": Known(meaningless={"…": "it does nothing"}),
    "<script>": Known(frozenset(("<content>",)), meaningless={"language": "scripts in all languages are listed"}),
    "<BehaviorLayer>": Known(frozenset(("<BehaviorKeyframe>",)), meaningless={"name": _DRAWING}),
    "<BehaviorKeyframe>": Known(
        frozenset(("<Diagram>",)), meaningless={"name": _DRAWING, "index": "its boxes are left out"}
    ),
    "<Diagram>": Known(frozenset(("<Box>",)), meaningless={"scale": _DRAWING, "<Link>": _WIRES}),
    "<ActuatorList>": Known(
        frozenset(("<ActuatorCurve>",)), meaningless={"model": "joints are checked against the robot's body"}
    ),
    "<ActuatorCurve>": Known(
        read=frozenset(("actuator", "mute", "unit", "<Key>")),
        meaningless={"name": _DRAWING, "recordable": "only for recording in the editor"},
    ),
    "<Key>": Known(
        read=frozenset(("frame", "value", "<Tangent>")),
        meaningless={
            "smooth": "only for moving handles in the editor",
            "symmetrical": "only for moving handles in the editor",
        },
    ),
    "<Tangent>": Known(frozenset(("side", "abscissaParam", "ordinateParam", "interpType"))),
    "interpType": Known(frozenset(("bezier", "bezier_auto", "linear", "constant"))),
}
"""The parts of a `.xar` that are read or meaningless; boxes without the timeline are reported as a whole."""

Timelines = dict[str, XmlElement]


class Flags(NamedTuple):
    """The range of frames in a timeline that is played, and the frame rate."""

    first: float
    """The first frame that is played."""
    last: float
    """The last frame that is played; infinite without an End flag."""
    fps: float
    """The frame rate [1/s]."""

    def time(self, frame: float) -> float:
        """Return a frame's time [s]; the first frame that is played is at 1 / fps."""
        return (frame - self.first + 1) / self.fps


def read_choregraphe(file: MotionFile, findings: ConversionFindings) -> JointCurves:
    """Return the curves of the timeline `file.timeline`, or of the only timeline if that name is empty.

    `file.hands` are the robot's hands besides NAO's, whose keys are openings. Raises ForeignFileError if the file is
    not a behaviour, or if the timeline does not exist or is ambiguous.
    """
    root = parse_xml(file.name, file.content, most=MAX_CHOREGRAPHE_ELEMENTS)
    if local(root) not in ROOTS:
        raise broken(root.place, "not-a-motion", f"this is not a Choregraphe behaviour: it begins with `{local(root)}`")
    if (version := root.get("xar_version", VERSION)) != VERSION:
        message = f"`xar_version` is {version[:20]}: the file is read as version {VERSION}"
        findings.changed(root.place, message, "compare the motion with the original")
    timelines = dict(_timelines(root))
    chosen = _chosen(root, timelines, file.timeline)
    _others(root, chosen, findings, asked=bool(file.timeline))
    _tell_around(root, chosen, findings)
    flags = _flags(chosen, findings)
    curves: dict[str, list[CurvePoint]] = {}
    for curve in _under(chosen, "ActuatorCurve"):
        joint = curve.get("actuator")
        keys = list(_under(curve, "Key"))
        if curve.get("mute") == "1":
            if keys:
                findings.lost(curve.place, f"`{joint}` is muted")
            continue
        if curve.get("mute", "0") != "0":
            findings.lost(
                curve.place, f"`mute` of `{joint}` is `{curve.get('mute')[:20]}`: it is read as 0", "write 0 or 1"
            )
        if joint in curves:
            findings.lost(curve.place, f"a second curve for `{joint}` is left out")
        elif points := list(_points(curve, _played(keys, curve, flags, findings), flags, findings, file.hands)):
            curves[joint] = points
    return curves


def is_choregraphe_list(content: bytes) -> bool:
    """Return whether a file is a `.pml`, a project's file list."""
    if b"<Package" not in content[:1_000]:
        return False
    try:
        return local(parse_xml("", content)) == "Package"
    except ForeignFileError:
        return False


def choregraphe_list(content: bytes) -> str:
    """Return the message that a `.pml` can't be imported, with the files to import instead."""
    named = [e for e in parse_xml("", content).walk() if local(e) == "BehaviorDescription"]
    files = [f"{e.get('src')}/{e.get('xar', 'behavior.xar')}".strip("/") for e in named]
    instead = (
        f"import {' or '.join(f'`{file}`' for file in files[:20])} instead"
        if files
        else "the project lists no behaviour"
    )
    return f"is the file list of a Choregraphe project and contains no motion: {instead}"


def _tell_around(root: XmlElement, chosen: XmlElement, findings: ConversionFindings) -> None:
    """Report unknown parts of the timeline and its enclosing boxes, and the boxes' scripts."""
    way = _way(root, chosen)
    seen = {id(element) for element in way}
    waiting = [chosen]
    while waiting:
        inner = [child for child in waiting.pop().children if local(child) != "Box"]
        seen.update(map(id, inner))
        waiting += inner
    tell_losses(root, KNOWN, findings, lambda element: id(element) in seen)
    for box in way:
        if local(box) == "Timeline" and (enabled := box.get("enable", "1")) not in ("0", "1"):
            findings.lost(
                box.place, f"`enable` is `{enabled[:20]}`: the timeline is read as switched on", "write 0 or 1"
            )
        for script in (child for child in box.children if local(child) == "script"):
            if any(part.text.strip() for part in script.walk()):
                findings.lost(script.place, f"the script of the box `{box.get('name')}` is left out")


def _way(root: XmlElement, wanted: XmlElement) -> list[XmlElement]:
    """Return the elements from the root down to `wanted`, inclusive."""
    above: dict[int, XmlElement] = {}
    for element in root.walk():
        above.update((id(child), element) for child in element.children)
    way = [wanted]
    while id(way[-1]) in above:
        way.append(above[id(way[-1])])
    return way[::-1]


def _flags(timeline: XmlElement, findings: ConversionFindings) -> Flags:
    """Return a timeline's range of played frames and its frame rate; report invalid flags.

    By default, all frames from 1 on are played.
    """
    found = {}
    for flag, none in (("start_frame", 1.0), ("end_frame", -1.0)):
        said = timeline.get(flag, f"{none:g}")
        frame = number(said)
        if frame is None or (frame < 1 and frame != none):
            findings.lost(
                timeline.place,
                f"`{flag}` is `{said[:20]}`, which is not a frame number",
                f"write a frame number, or {none:g} for none",
            )
            frame = none
        found[flag] = frame
    first, last = found["start_frame"], inf if found["end_frame"] < 1 else found["end_frame"]
    if last < first:
        message = f"the End flag ({last:g}) is before the Start flag ({first:g}): no key is played"
        findings.lost(timeline.place, message)
    return Flags(first, last, _pace(timeline, findings))


def _played(
    keys: list[XmlElement], curve: XmlElement, flags: Flags, findings: ConversionFindings
) -> Iterator[XmlElement]:
    """Yield the keys between the flags or without a valid frame; report the others once per curve."""
    outside = []
    for key in keys:
        frame = number(key.get("frame"))
        if frame is None or flags.first <= frame <= flags.last:
            yield key
        else:
            outside.append(key)
    if outside:
        count, verb = ("a key", "is") if len(outside) == 1 else (f"{len(outside)} keys", "are")
        where = f"of `{curve.get('actuator')}` before the Start flag or after the End flag"
        findings.changed(outside[0].place, f"{count} {where} {verb} left out, as in Choregraphe")


def _pace(timeline: XmlElement, findings: ConversionFindings) -> float:
    """Return a timeline's frame rate [1/s]; report an invalid one and return the default."""
    fps = number(timeline.get("fps"))
    if fps is not None and fps > 0:
        return fps
    findings.changed(
        timeline.place, f"the timeline has no `fps` above 0: it is read with {DEFAULT_FPS:g} frames per second"
    )
    return DEFAULT_FPS


def _chosen(root: XmlElement, timelines: Timelines, name: str) -> XmlElement:
    if not timelines:
        raise broken(root.place, "not-a-motion", "no timeline in the file moves a joint")
    if name in timelines:
        return timelines[name]
    if name:
        hint = did_you_mean(name, timelines, "it has")
        raise broken(root.place, "not-a-motion", f"there is no timeline `{name}`", hint)
    if len(timelines) > 1:
        names = ", ".join(f"`{n}`" for n in timelines)
        raise broken(
            root.place, "not-a-motion", f"the file has several timelines: {names}", "choose one: --timeline NAME"
        )
    return next(iter(timelines.values()))


def _timelines(element: XmlElement, box: str = "") -> Iterator[tuple[str, XmlElement]]:
    """Yield the enabled timelines that move joints, with their boxes' names; repeated names get a number."""
    found: dict[str, int] = {}
    for name, timeline in _all_timelines(element, box):
        if timeline.get("enable") != "0" and any(local(key) == "Key" for key in timeline.walk()):
            found[name] = found.get(name, 0) + 1
            yield (f"{name} {found[name]}" if found[name] > 1 else name), timeline


def _all_timelines(element: XmlElement, box: str) -> Iterator[tuple[str, XmlElement]]:
    waiting = [(element, box)]
    while waiting:
        here, box = waiting.pop()
        if local(here) == "Timeline" and any(local(child) == "ActuatorList" for child in here.children):
            yield box, here
        box = here.get("name") if local(here) == "Box" else box
        waiting.extend((child, box) for child in reversed(here.children))


def _others(root: XmlElement, chosen: XmlElement, findings: ConversionFindings, *, asked: bool) -> None:
    """Report the boxes that are left out; if a timeline was requested, boxes outside it are not a loss."""
    inside = {id(element) for element in chosen.walk()}
    for box in root.walk():
        around = any(element is chosen or local(element) == "Box" for element in list(box.walk())[1:])
        if local(box) == "Box" and (id(box) in inside or not around):
            say = findings.changed if asked and id(box) not in inside else findings.lost
            say(box.place, f"the box `{box.get('name')}` is left out: only the joints of a timeline are imported")


def _points(
    curve: XmlElement, keys: Iterator[XmlElement], flags: Flags, findings: ConversionFindings, hands: Collection[str]
) -> Iterator[CurvePoint]:
    joint = curve.get("actuator")
    factor = _factor(curve, findings, hand=joint in (*NAO_HANDS, *hands))
    for key in keys:
        frame, value = number(key.get("frame")), number(key.get("value"))
        if frame is None or value is None:
            findings.lost(key.place, f"a key of `{joint}` has no frame or no value")
            continue
        tangents: dict[str, XmlElement] = {}
        for tangent in _under(key, "Tangent"):
            if (side := tangent.get("side")) not in ("left", "right") or side in tangents:
                findings.lost(
                    tangent.place, f"a tangent of `{joint}` has the side `{side[:20]}`", "write left or right"
                )
            tangents.setdefault(side, tangent)
            kind = tangent.get("interpType")
            for _, hint in KNOWN["interpType"].losses([kind]):
                findings.lost(tangent.place, f"unknown interpolation `{kind[:20]}` for `{joint}`", hint)
        kinds = {tangent.get("interpType") for tangent in tangents.values()}
        if "constant" in kinds:
            findings.changed(
                key.place, f"`{joint}` jumps to the next key; no joint can jump, so it moves in a straight line"
            )
        left = tangents.get("left")
        straight = left is not None and left.get("interpType") in ("linear", "constant")
        into, out = (_handle(tangents.get(side), flags.fps, factor, findings) for side in ("left", "right"))
        yield CurvePoint(flags.time(frame), value * factor, key.place, straight, into, out)


def _factor(curve: XmlElement, findings: ConversionFindings, *, hand: bool) -> float:
    """Return the factor from a key's value to [rad] or a hand's opening; report a `unit` that differs."""
    joint, unit, usual = curve.get("actuator"), curve.get("unit"), "1" if hand else "0"
    if unit not in ("", usual):
        meant = "an opening from 0 to 1" if hand else "an angle in degrees"
        message = f"`unit` of `{joint}` is `{unit[:20]}`: its keys are read as {meant}"
        findings.changed(curve.place, message, f'Choregraphe writes `unit="{usual}"`')
    return 1.0 if hand else radians(1.0)


def _handle(tangent: XmlElement | None, fps: float, factor: float, findings: ConversionFindings) -> BezierHandle:
    """Return a Bezier tangent's (dt [s], da [rad]); (0, 0) for any other, and for invalid parameters, reported."""
    if tangent is None or tangent.get("interpType") != "bezier":
        return 0.0, 0.0
    frames, value = (number(tangent.get(name, "0")) for name in ("abscissaParam", "ordinateParam"))
    if frames is None or value is None:
        findings.lost(tangent.place, "a tangent is left out: `abscissaParam` and `ordinateParam` must be numbers")
        return 0.0, 0.0
    if (frames > 0) == (tangent.get("side") == "left") and frames:
        findings.lost(
            tangent.place, "a tangent is left out: `abscissaParam` must be below 0 on the left, above 0 on the right"
        )
        return 0.0, 0.0
    return frames / fps, value * factor


def _under(element: XmlElement, tag: str) -> Iterator[XmlElement]:
    """Yield the elements with a tag inside an element, except those in nested boxes."""
    waiting = list(reversed(element.children))
    while waiting:
        here = waiting.pop()
        if local(here) == tag:
            yield here
        elif local(here) != "Box":
            waiting.extend(reversed(here.children))
