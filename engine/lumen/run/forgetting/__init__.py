"""Somebody forgotten by an exhibition: in its files, and what is told of it."""
