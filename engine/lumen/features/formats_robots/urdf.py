"""Reads the joints and links of a robot's URDF (wiki.ros.org/urdf/XML), without transmissions and simulators' tags."""

from lumen.features.formats_robots.orientation import AXES, NestedFrame, Numbers, euler, rotated
from lumen.features.formats_robots.parts import ModelJoint, RobotModel, follows
from lumen.project.formats.conversion_findings import ConversionFindings
from lumen.project.formats.known import FormatTable, Known
from lumen.project.formats.known_elements import tell_losses
from lumen.project.formats.xml_elements import XmlElement

_LOOKS = "only its appearance"
_SIMULATOR = "a setting for another simulator"
_ROUND_BAR = Known(frozenset(("radius", "length")))
_LINK = Known(frozenset(("link",)))
KNOWN: FormatTable = {
    "<robot>": Known(
        read=frozenset(("name", "<link>", "<joint>")),
        lost={"<mujoco>": "write it into the MJCF", "<sensor>": "write it into the MJCF"},
        meaningless={
            "version": "of the format", "<material>": _LOOKS, "<gazebo>": _SIMULATOR, "<ros2_control>": _SIMULATOR,
            "<transmission>": "the limits of joints are read from `<limit>`",
        },
    ),
    "<link>": Known(
        read=frozenset(("name", "<inertial>", "<collision>")), meaningless={"<visual>": _LOOKS, "type": _SIMULATOR}
    ),
    "<inertial>": Known(frozenset(("<origin>", "<mass>", "<inertia>"))),
    "<mass>": Known(frozenset(("value",))),
    "<inertia>": Known(frozenset(("ixx", "ixy", "ixz", "iyy", "iyz", "izz"))),
    "<collision>": Known(
        read=frozenset(("<origin>", "<geometry>")),
        meaningless={
            "name": "nothing refers to it", "group": _SIMULATOR, "<verbose>": _SIMULATOR, "<material>": _LOOKS,
        },
    ),
    "<geometry>": Known(frozenset(("<box>", "<cylinder>", "<sphere>", "<capsule>", "<mesh>"))),
    "<box>": Known(frozenset(("size",))),
    "<sphere>": Known(frozenset(("radius",))),
    **dict.fromkeys(("<cylinder>", "<capsule>"), _ROUND_BAR),
    "<mesh>": Known(frozenset(("filename", "scale"))),
    "<joint>": Known(
        read=frozenset(
            ("name", "type", "<origin>", "<parent>", "<child>", "<axis>", "<limit>", "<mimic>", "<dynamics>")
        ),
        lost={"<safety_controller>": "write its narrower limits into `<limit>`"},
        meaningless={"<calibration>": "in Lumen, a joint needs no calibration"},
    ),
    "<joint> that is fixed": Known(meaningless={"name": "its two links become one body", "xyz": "it does not turn"}),
    "<origin>": Known(frozenset(("xyz", "rpy"))),
    "<parent>": _LINK,
    "<child>": _LINK,
    "<axis>": Known(frozenset(("xyz",))),
    "<limit> of a joint that follows another": Known(
        meaningless=dict.fromkeys(("velocity", "effort"), "it has no motor")
    ),
    "<limit>": Known(frozenset(("lower", "upper", "effort", "velocity"))),
    "<mimic>": Known(frozenset(("joint", "multiplier", "offset"))),
    "<dynamics>": Known(frozenset(("damping", "friction"))),
}  # fmt: skip
"""The parts of a URDF that are read for the body file or for MuJoCo's MJCF, lost or meaningless."""

_HINGES = ("revolute", "continuous")
_ORIGIN = (0.0, 0.0, 0.0)


def urdf_model(root: XmlElement, file: str, findings: ConversionFindings) -> RobotModel:
    """Return the robot; report properties of joints that a body file can't have."""
    return _UrdfReader(root, file, findings).read()


class _UrdfReader:
    def __init__(self, root: XmlElement, file: str, findings: ConversionFindings) -> None:
        self.root, self.file, self.findings = root, file, findings
        self.numbers = Numbers(findings)
        self.links: dict[str, str] = {link.get("name"): "" for link in root.of("link") if link.get("name")}
        self.above: dict[str, XmlElement] = {}
        self.driven: dict[str, XmlElement] = {}

    def read(self) -> RobotModel:
        """Return the robot; report the parts of the file that are left out or changed."""
        tell_losses(self.root, KNOWN, self.findings)
        joints = [joint for joint in self.root.of("joint") if self.known(joint)]
        frames: dict[str, NestedFrame] = {}
        found = [hinge for joint in joints if (hinge := self.hinge(joint, self.frame(joint, frames)))]
        names = {hinge.name for hinge in found}
        for hinge in found:
            if hinge.follows and hinge.follows not in names:
                self.findings.lost(
                    hinge.place, f"`{hinge.name}` follows `{hinge.follows}`, which is not a joint that turns"
                )
            elif hinge.name in self.driven:
                self.findings.changed(self.driven[hinge.name].place, *follows(hinge.name, hinge.follows))
        found = [hinge for hinge in found if hinge.name not in self.driven or hinge.follows not in names]
        return RobotModel(self.root.get("name"), self.file, self.root.place, found, self.links)

    def known(self, joint: XmlElement) -> bool:
        """Return whether a joint connects two links of the file and is the child's only parent joint.

        If so, record the child's parent; otherwise report the joint.
        """
        name, ends = joint.get("name"), []
        for end in ("parent", "child"):
            link = next((element.get("link") for element in joint.of(end)), "")
            if link not in self.links:
                said = f"has the {end} `{link}`, which does not exist" if link else f"has no {end}"
                hint = f'write `<{end} link="…"/>` with a link of the file'
                self.findings.lost(joint.place, f"the joint `{name}` {said}", hint)
                return False
            ends.append(link)
        parent, child = ends
        if child in self.above or self.hangs(parent, child):
            self.findings.lost(joint.place, f"`{child}` is the child of two joints", "give each link one parent joint")
            return False
        self.links[child], self.above[child] = parent, joint
        return True

    def hangs(self, link: str, on: str) -> bool:
        """Return whether `link` is `on` or a descendant of it."""
        while link and link != on:
            link = self.links.get(link, "")
        return link == on

    def frame(self, joint: XmlElement, frames: dict[str, NestedFrame]) -> NestedFrame:
        """Return the frame of a joint's child in the robot's frame, with all joints at zero; `frames` is a cache."""
        chain: list[XmlElement] = []
        link = next(joint.of("child")).get("link")
        while link in self.above and link not in frames:
            chain.append(self.above[link])
            link = self.links[link]
        frame = frames.get(link, NestedFrame())
        for step in reversed(chain):
            origin = next(step.of("origin"), None)
            if origin is not None:
                turned = euler(self.numbers.vector(origin, "rpy", _ORIGIN), "XYZ")
                frame = NestedFrame(self.numbers.vector(origin, "xyz", _ORIGIN), turned).within(frame)
            frames[next(step.of("child")).get("link")] = frame
        return frame

    def hinge(self, joint: XmlElement, frame: NestedFrame) -> ModelJoint | None:
        """Return a joint that turns, or None for any other; report others that are not fixed."""
        kind, name = joint.get("type"), joint.get("name")
        if kind == "fixed":
            return None
        if kind not in _HINGES:
            hint = "only joints that turn are imported: if it turns, write `revolute`"
            self.findings.lost(
                joint.place, f"the joint `{name}` has {f'the type `{kind}`' if kind else 'no type'}", hint
            )
            return None
        axis = next(joint.of("axis"), None)
        axis_here = self.numbers.vector(axis, "xyz", AXES["x"]) if axis is not None else AXES["x"]
        limit = next(joint.of("limit"), None)
        low, high, speed, effort = self.limits(limit)
        if kind == "revolute" and low is None:
            hint = 'write `<limit lower="-1" upper="1" …/>` [rad]'
            self.findings.lost(joint.place, f"the joint `{name}` has no limits", hint)
        leader, equal = self.mimic(joint)
        if leader and not equal:
            self.driven[name] = next(joint.of("mimic"))
        return ModelJoint(
            name, next(joint.of("child")).get("link"), joint.place, frame.place, rotated(frame.turned, axis_here),
            low if kind == "revolute" else None, high if kind == "revolute" else None, speed, effort, leader,
        )  # fmt: skip

    def limits(self, limit: XmlElement | None) -> tuple[float | None, float | None, float | None, float | None]:
        """Return the lowest and highest angle [rad], the speed [rad/s] and the torque [N m].

        A missing angle is 0 if the other one is given, else None. An empty range is reported, and both angles are None.
        Speed and torque are None if they are missing or not positive.
        """
        if limit is None:
            return None, None, None, None
        low, high, speed, effort = (self.numbers.one(limit, key) for key in ("lower", "upper", "velocity", "effort"))
        if low is None and high is not None:
            low = 0.0
        if high is None and low is not None:
            high = 0.0
        if low is not None and high is not None and low >= high:
            self.findings.lost(
                limit.place, f"the range from {low:g} to {high:g} is empty", "write an `upper` above `lower`"
            )
            low = high = None
        return low, high, speed if speed and speed > 0 else None, effort if effort and effort > 0 else None

    def mimic(self, joint: XmlElement) -> tuple[str, bool]:
        """Return the name of the joint that this one follows, or empty, and whether both angles are equal.

        A `<mimic>` that names no joint is reported.
        """
        mimic = next(joint.of("mimic"), None)
        if mimic is None:
            return "", True
        factor, offset = self.numbers.one(mimic, "multiplier"), self.numbers.one(mimic, "offset")
        if not mimic.get("joint"):
            self.findings.lost(
                mimic.place, f"the `<mimic>` of `{joint.get('name')}` names no joint", 'write `<mimic joint="…"/>`'
            )
        return mimic.get("joint"), factor in (None, 1.0) and offset in (None, 0.0)
