"""An exhibition in processes of its own: robot, brain, motion and visitor, which know each other by the bus alone."""
