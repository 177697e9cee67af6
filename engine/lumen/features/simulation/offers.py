"""The NAO in MuJoCo, through dm_control. Importing this imports them; OpenGL is chosen just before.

Raises MissingExtraError where they are not installed.
"""

from lumen.features.simulation import gl as gl  # first of all: it chooses what mujoco draws with
from lumen.features.simulation import installed as installed  # then: it names what is not installed
from lumen.features.simulation.rendering import available
from lumen.features.simulation.robot import SimulatedRobot

__all__ = ["SimulatedRobot", "available"]
