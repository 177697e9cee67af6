"""A small project, made of values: a few joints and motions, the routes of the senses, the shipped schemas."""

import json

from lumen.language.lights import LIGHT_GROUPS
from lumen.language.machines import MachineDefinition, State, StateKind
from lumen.language.motions import Keyframe, MotionDefinition
from lumen.language.projects import Project
from lumen.language.robots import Body, Camera, Joint, Ultrasound
from lumen.language.roles import Base, JointRole, Roles
from lumen.language.routes import Direction, Route
from tests import ROOT
from tests.scanning import matching

MESSAGES = ROOT / "schemas/messages"
ENDING = ".schema.json"

JOINTS = {
    name: Joint(name, low, high)
    for name, low, high in [
        ("HeadYaw", -2.0, 2.0),
        ("HeadPitch", -0.6, 0.5),
        ("LHipPitch", -1.5, 0.4),
        ("LAnklePitch", -1.1, 0.9),
        ("RHand", 0.0, 1.0),
    ]
}
TACTILE = (
    "RightBumper", "LeftBumper", "ChestButton", "FrontTactil", "MiddleTactil", "RearTactil", "HandRightBack",
    "HandRightLeft", "HandRightRight", "HandLeftBack", "HandLeftLeft", "HandLeftRight",
)  # fmt: skip
BODY = Body(
    name="NAO",
    mjcf="nao.xml",
    joints=JOINTS,
    parts={"head": ("HeadYaw", "HeadPitch")},
    postures={name: dict.fromkeys(JOINTS, 0.0) for name in ("Stand", "StandInit", "Crouch")},
    coupled=(),
    camera=Camera(320, 240, 1.06, 0.83, (0.0, 0.0, 0.0), 0.0),
    tactile=TACTILE,
    hands=("RHand",),
    sonar=Ultrasound(0.01, 3.0, 1.05),
    roles=Roles(
        head={"yaw": JointRole("HeadYaw"), "pitch": JointRole("HeadPitch")},
        base=Base("biped"),
        lights={name: (name,) for name in LIGHT_GROUPS},
    ),
)
SENSES = {"image": 0.066, "joint": 0.06, "sonar": 0.1, "tactile": 0.1, "battery": 1.0}


def messages() -> dict[str, dict[str, object]]:
    """Return the shipped message schemas by name."""
    return {
        path.name.removesuffix(ENDING): json.loads(path.read_text("utf-8")) for path in matching(MESSAGES, f"*{ENDING}")
    }


def project(**changes: object) -> Project:
    """Return the project, with other values for these fields of `Project`."""
    out = {n: Route(n, f"avatar.{{robot}}.data.{n}", Direction.OUT, n, every=every) for n, every in SENSES.items()}
    face = Route("face", "lumen.visual.face.detection", Direction.IN, "face.detection", event="face")
    command = Route("command", "avatar.{robot}.command", Direction.IN, "command")
    nod = {"HeadYaw": (Keyframe(1.0, 0.1),)}
    fields: dict[str, object] = {
        "root": "", "name": "test", "robot": "NAO", "body": BODY, "hall": "", "behavior": "tour",
        "behaviors": {"tour": MachineDefinition("tour", {"": State("", StateKind.ATOMIC)})},
        "motions": {n: MotionDefinition(n, 1.0, nod) for n in ("goodbye", "dance", "sing", "photo")},
        "routes": {**out, "face": face, "command": command},
        "messages": messages(),
        "languages": ("en", "id"),
    }  # fmt: skip
    return Project(**{**fields, **changes})  # type: ignore[arg-type]
