"""Walking: footsteps, the path of the centre of mass above them, and the legs' joints, planned from each landed foot.

Nothing here touches a robot: feet and a goal go in, joint angles come out, tick by tick.
"""

from lumen.interpreters.gait.footsteps import Feet, Step, corners, middle
from lumen.interpreters.gait.gait import CentreOfMass, Gait, Tick
from lumen.interpreters.gait.legs import JOINTS, SIDES, Side, foot_from
from lumen.interpreters.gait.pace import GENTLE, Pace
from lumen.interpreters.gait.poses import Pose
from lumen.interpreters.gait.velocity import Velocity, fastest

__all__ = [
    "GENTLE",
    "JOINTS",
    "SIDES",
    "CentreOfMass",
    "Feet",
    "Gait",
    "Pace",
    "Pose",
    "Side",
    "Step",
    "Tick",
    "Velocity",
    "corners",
    "fastest",
    "foot_from",
    "middle",
]
