"""Lumen installed from its wheel into an environment that has nothing else: its size, its functions, its messages."""
