"""Saved files on a running exhibition: judged beside it, staged, and active between two of its steps."""
