"""Lumen installed from its wheel into an environment that has nothing else: its size, what works, what is said."""
