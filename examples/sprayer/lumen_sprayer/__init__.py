"""A feature of Lumen: a sprayer of scents beside the robot."""
