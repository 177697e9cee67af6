"""Reload of saved files by a running exhibition: checked beside it, staged, and activated between two steps."""
