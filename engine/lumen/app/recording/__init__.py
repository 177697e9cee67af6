"""What is said on the bus of an exhibition, recorded: into a file, and always the last minutes of it."""
