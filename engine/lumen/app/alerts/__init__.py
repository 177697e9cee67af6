"""Somebody is told: of what, how it reaches them, and how often."""
