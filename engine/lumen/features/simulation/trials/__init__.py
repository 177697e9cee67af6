"""Motions in simulation: what the robot, and others much like it, come to when they play them.

Who calls hands over a robot that stands and waits. Nothing here knows how it is simulated.
"""
