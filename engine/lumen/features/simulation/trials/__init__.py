"""Play motions in simulation, on the robot and on slightly different variants, and judge the outcomes.

`trial.py` receives a robot that stands and waits, and does not depend on how it is simulated.
"""
