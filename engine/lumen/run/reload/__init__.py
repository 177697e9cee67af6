"""Reload of saved files by a running exhibition: checked separately, staged, and activated between two steps."""
