"""Stories made from recorded visits: the visitor's actions are played again, and the robot's are expected."""
