"""NAO's head, as far as a tracker needs it: joints, coupled limits, camera."""

from math import radians

from lumen.language.robots import Body, Camera, CoupledLimit, Joint
from lumen.language.roles import JointRole, Roles

TOP = Camera(320, 240, radians(60.97), radians(47.64), (0.05871, 0.0, 0.06364), 0.0209)

_ROWS = (
    (0.0, -0.671951, 0.515047),
    (0.486074, -0.671951, 0.422021),
    (0.756077, -0.548033, 0.370010),
    (0.903033, -0.479965, 0.330041),
    (1.089958, -0.430049, 0.300022),
    (1.526988, -0.330041, 0.200015),
    (2.086017, -0.449073, 0.330041),
)
COUPLED = CoupledLimit("HeadPitch", "HeadYaw", tuple([(-y, a, b) for y, a, b in _ROWS[:0:-1]] + list(_ROWS)))

HEAD = Body(
    name="nao",
    mjcf="nao.xml",
    joints={
        "HeadYaw": Joint("HeadYaw", -2.08567, 2.08567, 8.26797),
        "HeadPitch": Joint("HeadPitch", -0.671952, 0.514872, 7.19407),
    },
    parts={"head": ("HeadYaw", "HeadPitch")},
    postures={},
    coupled=(COUPLED,),
    camera=TOP,
    tactile=(),
    roles=Roles(head={"yaw": JointRole("HeadYaw"), "pitch": JointRole("HeadPitch")}),
)
