"""Lint of the projects on a command line: of their files, of a reload to them, and by physics."""
