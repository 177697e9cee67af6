"""A fleet's logic without I/O: rollouts, the orders that robots accept, and the robots' reports."""
