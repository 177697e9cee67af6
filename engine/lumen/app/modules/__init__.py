"""The modules beside robot, brain and motion: made by name, inside `lumen run` or in a process of their own."""
