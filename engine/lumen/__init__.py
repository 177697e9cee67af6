"""Lumen: the behaviour of a humanoid robot, written in YAML."""

__version__ = "0.1.0"
