"""The clocks of an exhibition: real, simulated, virtual, and one that follows a robot's."""
