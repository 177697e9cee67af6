"""Forget a person in an exhibition and its files, and report the result."""
