"""Walking: footsteps, the path of the centre of mass above them, and the legs' joints, planned from each landed foot.

Nothing here touches a robot: feet and a goal go in, joint angles come out, tick by tick.
"""

from lumen.motion.gait.footsteps import Feet, Footstep, Velocity, corners, fastest, fastest_of, middle
from lumen.motion.gait.gait import CentreOfMass, Gait, GaitTick
from lumen.motion.gait.legs import SIDES, LegGeometry, Side, SoleSize
from lumen.motion.gait.parameters import FOUND, GaitParameters, Paces, paces_of
from lumen.motion.gait.poses import Pose

__all__ = [
    "FOUND",
    "SIDES",
    "CentreOfMass",
    "Feet",
    "Footstep",
    "Gait",
    "GaitParameters",
    "GaitTick",
    "LegGeometry",
    "Paces",
    "Pose",
    "Side",
    "SoleSize",
    "Velocity",
    "corners",
    "fastest",
    "fastest_of",
    "middle",
    "paces_of",
]
