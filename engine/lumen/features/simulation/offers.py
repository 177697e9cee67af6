"""The NAO in MuJoCo, through dm_control. Importing this imports both (`physics.py`)."""

from lumen.features.simulation.rendering import available
from lumen.features.simulation.robot import SimulatedRobot

__all__ = ["SimulatedRobot", "available"]
