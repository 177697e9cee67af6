"""Reads the parts of a robot's MJCF that a body file needs, without MuJoCo."""

from math import degrees, pi, radians

from lumen.features.formats_robots.mjcf_known import ACTUATORS, KNOWN
from lumen.features.formats_robots.orientation import (
    AXES,
    NestedFrame,
    Numbers,
    Quaternion,
    between,
    euler,
    of_axes,
    rotated,
    turn,
    unit,
)
from lumen.features.formats_robots.parts import ModelCamera, ModelJoint, RobotModel, follows
from lumen.project.formats.conversion_findings import ConversionFindings
from lumen.project.formats.known_elements import tell_losses
from lumen.project.formats.xml_elements import XmlElement

_MAIN = "main"


class Defaults:
    """A model's default classes: attributes by class and tag, including the attributes of enclosing classes."""

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
        """Return whether the model has a class with this name; an empty name is the main class."""
        return not name or name in self._classes

    def whole(self, element: XmlElement, childclass: str = "") -> XmlElement:
        """Return the element with the defaults of its class, else of `childclass`, else of the main class."""
        name = element.get("class") or childclass or _MAIN
        known = self._classes.get(name, self._classes[_MAIN])
        given = dict(known.get(element.tag, {}))
        if element.tag in ACTUATORS:
            given = {**known.get("general", {}), **given}
        return XmlElement(element.tag, {**given, **element.attributes}, element.place, element.children)


_ORIGIN = (0.0, 0.0, 0.0)
SAME_ANGLE = 1e-3
"""The tolerance for rounded angles [rad]."""
SAME_TORQUE = 1e-3
"""The relative difference between the torques in the two directions that is ignored."""
_FOVY = 45.0
_EQUAL = (0.0, 1.0, 0.0, 0.0, 0.0)
"""The coefficients of a joint whose angle equals another joint's."""
_PLACED_ELSEWHERE = ("include", "attach", "replicate", "composite", "flexcomp")
_SENSORS = ("gyro", "accelerometer")


def mjcf_model(root: XmlElement, file: str, findings: ConversionFindings) -> RobotModel:
    """Return the robot; report joints that a body file can't have, and elements that are not expanded."""
    return _MjcfReader(root, file, findings).read()


class _MjcfReader:
    def __init__(self, root: XmlElement, file: str, findings: ConversionFindings) -> None:
        self.root, self.file, self.findings = root, file, findings
        self.numbers, self.defaults = Numbers(findings), Defaults(root)
        compiler = {key: value for element in root.of("compiler") for key, value in element.attributes.items()}
        angle = self.one_of(root, compiler.get("angle", "degree"), "angle", ("radian", "degree"))
        self.angle = 1.0 if angle == "radian" else radians(1.0)
        self.sequence = compiler.get("eulerseq", "xyz")
        autolimits = compiler.get("autolimits", "true")
        self.autolimits = self.one_of(root, autolimits, "autolimits", ("false", "true")) == "true"
        if len(self.sequence) != len(_ORIGIN) or not set(self.sequence.lower()) <= set(AXES):
            findings.lost(
                root.place,
                f"`eulerseq` can't be `{self.sequence[:20]}`",
                "write three of x, y and z, in capitals for fixed axes",
            )
        self.motors: dict[str, XmlElement] = {}
        self.followers: dict[str, str] = {}
        self.joints: list[ModelJoint] = []
        self.links: dict[str, str] = {}
        self.cameras: list[ModelCamera] = []
        self.sites: dict[str, str] = {}

    def one_of(self, element: XmlElement, said: str, name: str, words: tuple[str, ...]) -> str:
        """Return the value of an attribute; report one that MuJoCo does not accept, and return the last of `words`."""
        if said in words:
            return said
        message = f"`{name}` is `{said[:40]}`: it is read as `{words[-1]}`"
        self.findings.lost(element.place, message, f"write one of {', '.join(words)}")
        return words[-1]

    def classed(self, element: XmlElement, childclass: str = "") -> XmlElement:
        """Return the element with the defaults of its class; report a missing class."""
        for name in (element.get("class"), childclass):
            if not self.defaults.has(name):
                hint = "correct the name, or add the class to `<default>`; MuJoCo rejects the model as it is"
                self.findings.lost(element.place, f"the class `{name[:60]}` does not exist", hint)
        return self.defaults.whole(element, childclass)

    def read(self) -> RobotModel:
        """Return the robot; report the parts of the file that are left out or changed."""
        tell_losses(self.root, KNOWN, self.findings, lambda element: element.tag != "equality")
        for element in self.root.walk():
            if element.tag in _PLACED_ELSEWHERE:
                message = f"`<{element.tag}>` is not expanded: joints that it adds are left out"
                self.findings.changed(
                    element.place, message, "if joints are missing, import the file that `mj_saveLastXML` writes"
                )
        for actuator in (e for block in self.root.of("actuator") for e in block.of(*ACTUATORS)):
            whole = self.classed(actuator)
            self.motors.setdefault(whole.get("joint"), whole)
        for pair in (e for block in self.root.of("equality") for e in block.of("joint")):
            self.equality(pair)
        for world in self.root.of("worldbody"):
            for body in world.of("body"):
                self.body(body, NestedFrame(), "", "")
        sensors = {e.tag: e.get("name") for block in self.root.of("sensor") for e in reversed(block.children)}
        materials = [e.get("name") for block in self.root.of("asset") for e in block.of("material")]
        known = {kind: sensors[kind] for kind in _SENSORS if sensors.get(kind)}
        name = self.root.get("model")
        return RobotModel(
            name, self.file, self.root.place, self.joints, self.links, self.cameras, self.sites, known, materials
        )

    def equality(self, pair: XmlElement) -> None:
        """Record a joint that equals another; report a joint that follows with other coefficients."""
        for name, hint in KNOWN["<equality> <joint>"].losses(pair.attributes):
            self.findings.lost(pair.place, f"`{name[:60]}` of `<joint>` in `<equality>` is left out", hint)
        follower, leader = pair.get("joint1"), pair.get("joint2")
        count = min(len(pair.get("polycoef").split()), len(_EQUAL))
        given = self.numbers.all(pair, "polycoef", count) if count else ()
        if pair.get("active") == "false" or not follower or not leader or given is None:
            return
        equal = (*given, *_EQUAL[count:]) == _EQUAL
        self.followers[follower] = leader if equal else ""
        if not equal:
            self.findings.changed(pair.place, *follows(follower, leader))

    def body(self, body: XmlElement, outer: NestedFrame, above: str, childclass: str) -> None:
        """Read the content of a body or frame, including nested ones."""
        childclass = body.get("childclass") or childclass
        frame = self.frame(body).within(outer)
        name = body.get("name") or above
        if body.tag == "body" and body.get("name"):
            self.links[name] = above
        for element in body.children:
            match element.tag:
                case "freejoint":
                    self.free(element)
                case "joint":
                    self.joint(self.classed(element, childclass), frame, name)
                case "camera":
                    self.camera(self.classed(element, childclass), name)
                case "site" if element.get("name"):
                    self.sites[element.get("name")] = name
                case "body" | "frame":
                    self.body(element, frame, name, childclass)

    def frame(self, element: XmlElement) -> NestedFrame:
        """Return an element's frame, relative to its parent's."""
        return NestedFrame(self.numbers.vector(element, "pos", _ORIGIN), self.turned(element))

    def turned(self, element: XmlElement) -> Quaternion:
        """Return an element's rotation from any of MJCF's forms; the identity without a valid one."""
        numbers = self.numbers
        if q := numbers.all(element, "quat", 4):
            return unit((q[0], q[1], q[2], q[3]))
        if e := numbers.all(element, "euler", 3):
            return euler((e[0] * self.angle, e[1] * self.angle, e[2] * self.angle), self.sequence)
        if a := numbers.all(element, "axisangle", 4):
            return turn((a[0], a[1], a[2]), a[3] * self.angle)
        if xy := numbers.all(element, "xyaxes", 6):
            return of_axes((xy[0], xy[1], xy[2]), (xy[3], xy[4], xy[5]))
        if z := numbers.all(element, "zaxis", 3):
            return between(AXES["z"], (z[0], z[1], z[2]))
        return NestedFrame().turned

    def joint(self, joint: XmlElement, frame: NestedFrame, link: str) -> None:
        """Add a hinge joint; report joints without a name or of another type."""
        name, kind = joint.get("name"), joint.get("type", "hinge")
        if kind == "free":
            self.free(joint)
        elif kind != "hinge":
            self.findings.lost(joint.place, f"the joint `{name}` is a `{kind}`: only joints that turn are imported")
        elif not name:
            self.findings.lost(joint.place, f"a joint of `{link}` has no name", "give it one in the model")
        elif self.followers.get(name) != "":
            low, high = self.limits(joint)
            motor = self.motors.get(name)
            self.held(joint, motor, low, high)
            self.joints.append(
                ModelJoint(
                    name, link, joint.place,
                    NestedFrame(self.numbers.vector(joint, "pos", _ORIGIN)).within(frame).place,
                    rotated(frame.turned, self.numbers.vector(joint, "axis", AXES["z"])),
                    low, high, None, self.effort(joint, motor), self.followers.get(name, ""),
                    motor is not None and motor.tag == "position" and motor.get("name") == name,
                    motor is not None and motor.tag == "velocity",
                )
            )  # fmt: skip

    def free(self, joint: XmlElement) -> None:
        """Report a free joint."""
        hint = "delete it: Lumen adds one when it places the robot in a hall"
        self.findings.lost(joint.place, "the model has a free joint to the world", hint)

    def limits(self, joint: XmlElement) -> tuple[float | None, float | None]:
        """Return the joint's range [rad]; both ends are None if it has no limits.

        An empty range is reported and ignored.
        """
        span = self.numbers.all(joint, "range", 2)
        limited = self.one_of(joint, joint.get("limited", "auto"), "limited", ("true", "false", "auto"))
        if not span or limited == "false" or (limited == "auto" and not self.autolimits):
            return None, None
        if span[0] >= span[1]:
            self.findings.lost(
                joint.place, f"the range {span[0]:g} to {span[1]:g} is empty", "make the second number the greater one"
            )
            return None, None
        return span[0] * self.angle, span[1] * self.angle

    def held(self, joint: XmlElement, motor: XmlElement | None, low: float | None, high: float | None) -> None:
        """Report a servo whose goals [rad] do not cover its joint's range, or are scaled by a `gear`."""
        if motor is None or motor.tag != "position":
            return
        span, gear = self.numbers.all(motor, "ctrlrange", 2), self.gear(motor)
        if gear != 1.0 and motor.get("name") == joint.get("name"):
            message = (
                f"the motor of `{motor.get('name')}` has a `gear` of {gear:g}: its goals are not the joint's angles"
            )
            self.findings.changed(motor.place, message, "delete `gear`: in Lumen, goals are angles of the joint")
        if motor.get("ctrllimited", "auto") == "false" or not span or span[0] >= span[1] or not gear:
            return
        least, most = sorted(end / gear for end in span)
        if low is None or high is None or least > low + SAME_ANGLE or most < high - SAME_ANGLE:
            reach = f"{degrees(least):.4g} to {degrees(most):.4g} deg"
            message = f"the motor of `{joint.get('name')}` turns it only from {reach}"
            self.findings.changed(motor.place, message, "give the joint this `range` in the body")

    def gear(self, motor: XmlElement) -> float:
        """Return the motor's turns per turn of the joint; 1 without a valid `gear`."""
        return float(word) if _is_number(word := (motor.get("gear", "1").split() or ["1"])[0]) else 1.0

    def effort(self, joint: XmlElement, motor: XmlElement | None) -> float | None:
        """Return the greatest torque [N m] that both the joint and its motor allow; None if neither has a limit."""
        most = []
        if span := self.numbers.all(joint, "actuatorfrcrange", 2):
            most.append(max(span))
            self.uneven(joint, [span])
        if motor is not None:
            gear = abs(self.gear(motor))
            spans = ["forcerange", "ctrlrange"] if motor.tag == "motor" else ["forcerange"]
            given = (self.numbers.all(motor, key, 2) for key in spans)
            spans_given = [span for span in given if span][:1]
            most += [max(span) * gear for span in spans_given]
            self.uneven(motor, spans_given)
        return min((torque for torque in most if torque > 0), default=None)

    def uneven(self, element: XmlElement, spans: list[tuple[float, ...]]) -> None:
        """Report torques that differ between the two directions."""
        for low, high in spans:
            if abs(low + high) > SAME_TORQUE * max(abs(low), abs(high)):
                message = (
                    f"`{element.get('name')}` has a torque of {low:g} to {high:g}: it gets {high:g} in both directions"
                )
                self.findings.changed(element.place, message)

    def camera(self, camera: XmlElement, link: str) -> None:
        """Add a camera that has a name; report and leave out one with an invalid angle of view."""
        if not camera.get("name"):
            return
        given = self.numbers.one(camera, "fovy")
        fovy = _FOVY if given is None else given
        if not 0.0 < fovy < 180.0:
            self.findings.lost(camera.place, f"`fovy` is {fovy:g} degrees: it must be above 0 and below 180")
            return
        position, ahead = self.numbers.vector(camera, "pos", _ORIGIN), rotated(self.turned(camera), (0.0, 0.0, -1.0))
        self.cameras.append(ModelCamera(camera.get("name"), link, position, ahead, fovy * pi / 180.0))


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True
