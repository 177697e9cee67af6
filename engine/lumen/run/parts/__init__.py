"""The parts that a node ticks: robot, visitor, modules and brain, or proxies for those in other processes."""
