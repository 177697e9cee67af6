"""What a node ticks: the robot, the visitor, the modules, the brain, or what stands for one in another process."""
