"""Recovery of a run after a crash, and the files that a run keeps for it."""
