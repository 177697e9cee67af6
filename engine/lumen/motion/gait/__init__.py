"""Walking: footsteps, the path of the centre of mass above them, and the joints of the legs.

The walk is planned anew from each landed foot. Nothing here accesses a robot: feet and a goal are the input, joint
angles for each tick are the output.
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
