"""Films of the simulated robot."""
