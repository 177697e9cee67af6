"""A real NAO, reached through NAOqi. `qi` is imported when a robot is connected to, and not before."""

from lumen.features.naoqi.physical_hall import PhysicalHall
from lumen.features.naoqi.robot import NaoqiRobot

__all__ = ["NaoqiRobot", "PhysicalHall"]
