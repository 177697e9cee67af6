"""Play motions in simulation, on the robot and on slightly different variants, and judge the outcomes.

`trial.py` receives a standing, waiting robot through an interface, and does not depend on the simulation.
"""
