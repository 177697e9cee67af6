"""Guesses the roles of a model's joints from their names and axes."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from lumen.features.formats_robots.parts import ModelCamera, ModelJoint, RobotModel
from lumen.language.roles import LEG_ROLES, SIDES
from lumen.project.formats.conversion_findings import ConversionFindings

_WORDS: Mapping[str, tuple[str, ...]] = {
    "head": ("head", "neck", "lowerneck", "upperneck"),
    "shoulder": ("shoulder", "sho", "humerus", "upperarm", "arm"),
    "elbow": ("elbow", "el", "radius", "forearm", "lowerarm"),
    "wrist": ("wrist", "wri"),
    "hip": ("hip", "femur", "thigh"),
    "knee": ("knee", "tibia", "shin", "calf"),
    "ankle": ("ankle", "ank", "foot"),
    "toe": ("toe", "toes"),
    "antenna": ("antenna", "ear"),
    "wheel": ("wheel",),
}
_PARTS: Mapping[str, str] = {"head": "head", "hip": "legs", "knee": "legs", "ankle": "legs", "toe": "legs"}
_TORSO = ("torso", "trunk", "chest", "thorax", "pelvis", "base", "body", "root")
_TURNS = {"yaw": "yaw", "pan": "yaw", "pitch": "pitch", "tilt": "pitch", "roll": "roll"}
_AXES = {"yaw": 2, "pitch": 1, "roll": 0}


@dataclass
class GuessedRoles:
    """The guessed roles of a robot."""

    joints: dict[str, str] = field(default_factory=dict)
    """The joint of each role, by the role's path."""
    reversed: set[str] = field(default_factory=set)
    """The roles whose joints turn in the opposite direction."""
    wheels: dict[str, str] = field(default_factory=dict)
    """The wheel joint of each side."""
    soles: dict[str, str] = field(default_factory=dict)
    """The site below each foot."""
    eyes: list[str] = field(default_factory=list)
    """The materials of the eyes."""
    camera: ModelCamera | None = None
    face: str = ""
    """The link with the face."""
    torso: str = ""
    """The torso's link."""
    biped: bool = False
    """Whether the robot can walk on two legs."""
    limbs: dict[str, str] = field(default_factory=dict)
    """The part of the body to which each joint belongs: head, arms or legs."""


def guess_roles(model: RobotModel, findings: ConversionFindings) -> GuessedRoles:
    """Return the roles guessed from names and axes; report legs that can't walk and arms without roles."""
    return _Guesser(model, findings).guess()


class _Guesser:
    def __init__(self, model: RobotModel, findings: ConversionFindings) -> None:
        self.model, self.findings, self.roles = model, findings, GuessedRoles()
        self.known = [(joint, *_place_of(joint.name)) for joint in model.joints]

    def guess(self) -> GuessedRoles:
        """Guess all roles, and return them."""
        roles, model = self.roles, self.model
        for joint, side, limb, turn in self.known:
            if joint.wheel or (limb == "wheel" and joint.low is None):
                if side and abs(joint.axis[1]) > 0.7:
                    roles.wheels.setdefault(side, joint.name)
            elif limb in ("head", "antenna", "hip", "knee", "ankle"):
                self.role(joint, side, limb, turn)
            roles.limbs[joint.name] = _PARTS.get(limb, "arms")
        for side in SIDES:
            self.arm(side)
        roles.torso = next(
            (n for word in _TORSO for n in model.links if word in n.lower()), next(iter(model.links), "")
        )
        roles.soles = self.soles()
        head = next(
            (
                j.link
                for j in reversed(model.joints)
                if j.name in (roles.joints.get("head.pitch"), roles.joints.get("head.yaw"))
            ),
            "",
        )
        roles.camera = next(
            (c for c in model.cameras if head and model.carries(head, c.link) and c.ahead[0] > 0.5), None
        )
        roles.face = roles.camera.link if roles.camera else head
        roles.eyes = [name for name in model.materials if "eye" in name.lower()]
        roles.biped = self.walks()
        return roles

    def role(self, joint: ModelJoint, side: str, limb: str, turn: str) -> None:
        """Assign a joint to its role, unless another joint has it; a missing turn follows from the axis."""
        turn = turn or _dominant(joint)
        path = {
            "head": f"head.{turn}",
            "antenna": f"antennas.{side}" if side else "",
            "hip": f"legs.{side}.hip-{turn}" if side else "",
            "knee": f"legs.{side}.knee" if side and turn == "pitch" else "",
            "ankle": f"legs.{side}.ankle-{turn}" if side and turn != "yaw" else "",
        }[limb]
        self.give(path, joint, joint.axis[_AXES[turn]] < -0.1)

    def give(self, path: str, joint: ModelJoint, backwards: bool) -> None:
        """Set a role's joint, unless the path is empty or the role already has a joint."""
        if path and path not in self.roles.joints:
            self.roles.joints[path] = joint.name
            if backwards:
                self.roles.reversed.add(path)

    def arm(self, side: str) -> None:
        """Guess an arm's roles if it points straight ahead with all joints at zero; report any other arm."""
        joints = {
            k: [(j, t) for j, s, limb, t in self.known if s == side and limb == k]
            for k in ("shoulder", "elbow", "wrist")
        }
        if not joints["shoulder"]:
            return
        start = joints["shoulder"][0][0]
        ends = [j for k in ("elbow", "wrist") for j, _ in joints[k]]
        way = [b - a for a, b in zip(start.position, ends[-1].position, strict=True)] if ends else [0.0] * 3
        if not ends or way[0] < 0.8 * sum(c * c for c in way) ** 0.5:
            message = f"the {side} arm has no roles: at zero it does not point straight ahead"
            hint = "use its joint names in motions, or turn its links in the model so that it points ahead at zero"
            self.findings.changed(start.place, message, hint)
            return
        for joint, _ in joints["shoulder"]:
            turn = _dominant(joint)
            role = {"pitch": "shoulder-pitch", "yaw": "shoulder-roll", "roll": "elbow-yaw"}[turn]
            self.give(f"arms.{side}.{role}", joint, joint.axis[_AXES[turn]] < 0)
        for joint, _ in joints["elbow"]:
            along = _dominant(joint) == "roll"
            bent = (joint.low or 0.0) + (joint.high or 0.0)
            backwards = joint.axis[0] < 0 if along else bent > 0 if side == "left" else bent < 0
            self.give(f"arms.{side}.{'elbow-yaw' if along else 'elbow-roll'}", joint, backwards)
        for joint, _ in joints["wrist"]:
            if _dominant(joint) == "roll":
                self.give(f"arms.{side}.wrist-yaw", joint, joint.axis[0] < 0)

    def soles(self) -> dict[str, str]:
        """Return the sites below both feet, found by name; empty unless both exist."""
        found: dict[str, str] = {}
        for site in self.model.sites:
            side, words = _side(_tokens(site)), site.lower()
            if side and ("sole" in words or "foot" in words):
                shortest = min(found.get(side, site), site, key=len)
                found[side] = shortest
        return found if len(found) == len(SIDES) else {}

    def walks(self) -> bool:
        """Return whether the robot has all parts that walking needs; report those that two legs lack."""
        has = {side: [name for name in LEG_ROLES if f"legs.{side}.{name}" in self.roles.joints] for side in SIDES}
        if not all(has.values()):
            return False
        lacking = [f"legs.{side}.{name}" for side in SIDES for name in LEG_ROLES if name not in has[side]]
        lacking += (
            [] if self.roles.soles else ["the sites `left_sole` and `right_sole` beneath the feet (x ahead, z up)"]
        )
        lacking += [f"a sensor `{kind}`" for kind in ("gyro", "accelerometer") if kind not in self.model.sensors]
        if lacking:
            message = (
                "the robot has legs, but lacks parts that walking needs: it is imported as a robot that can't walk"
            )
            self.findings.changed(self.model.root, message, f"add to the model: {', '.join(lacking)}")
        return not lacking


def _dominant(joint: ModelJoint) -> str:
    """Return the turn (yaw, pitch or roll) that is closest to the joint's axis, with all joints at zero."""
    return max(_AXES, key=lambda turn: abs(joint.axis[_AXES[turn]]))


def _tokens(name: str) -> list[str]:
    return [word.lower() for word in re.findall(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])", name)]


def _side(tokens: Sequence[str]) -> str:
    for token in tokens:
        if token in ("l", "left", "r", "right"):
            return "left" if token[0] == "l" else "right"
    return ""


def _place_of(name: str) -> tuple[str, str, str]:
    """Return the side, limb and turn in a joint's name, each empty if absent."""
    tokens = _tokens(name)
    side = _side(tokens)
    if tokens and not side and tokens[0][0] in "lr" and _limb(tokens[0][1:]):
        side, tokens = "left" if tokens[0][0] == "l" else "right", [tokens[0][1:], *tokens[1:]]
    limb = next((found for token in tokens if (found := _limb(token))), "")
    return side, limb, next((_TURNS[token] for token in tokens if token in _TURNS), "")


def _limb(token: str) -> str:
    """Return the limb for a token that is one of its words, or begins with one of at least four letters; else empty."""
    for limb, words in _WORDS.items():
        if token in words or any(len(word) > 3 and token.startswith(word) for word in words):
            return limb
    return ""
