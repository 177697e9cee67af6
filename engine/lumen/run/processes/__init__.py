"""An exhibition in separate processes: robot, brain, motion and visitor, which communicate only over the bus."""
