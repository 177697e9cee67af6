"""Lint's findings in common mistakes and in correct projects; `python -m tests.mistakes` prints the scores."""
