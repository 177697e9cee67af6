"""The logic of a fleet, without I/O: rollouts, the orders that robots accept, and their reports."""
