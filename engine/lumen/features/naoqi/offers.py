"""A real NAO, reached through NAOqi. `qi` is imported when a robot is connected to, and not before."""

from lumen.robots.naoqi.physical_hall import PhysicalHall
from lumen.robots.naoqi.robot import NaoqiRobot

__all__ = ["NaoqiRobot", "PhysicalHall"]
