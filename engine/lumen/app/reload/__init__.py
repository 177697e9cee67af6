"""Saved files on a running exhibition: judged beside it, staged, and in force between two of its steps."""
