"""Lint of the projects on a command line: their findings, stored findings, and the effects of a reload."""
